#include "io/text/yaml_node.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <system_error>

#include "io/text/nearest_name.h"
#include "io/text/text_file.h"
#include "io/text/utf8.h"
#include "ldso/error.h"

namespace ldso {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

/// Levels and values of a tree. An alias (*name) repeats what it names, perhaps around itself or a thousand times over:
/// a short text may be an endless tree.
constexpr int kMostLevels = 64;
constexpr int kMostValues = 200'000;

/// Throws Error if the tree is larger.
void check_tree(const YAML::Node& node, const std::string& origin, int level, int& values) {
  const auto fail = [&](const std::string& problem) {
    throw Error(origin + ":" + std::to_string(std::max(0, node.Mark().line) + 1), problem,
                "write it without aliases (*name)");
  };
  if (level > kMostLevels) fail("is nested more than 64 levels deep, or contains itself");
  if (++values > kMostValues) fail("has more than 200000 values");
  if (node.IsSequence()) {
    for (const YAML::Node& element : node) check_tree(element, origin, level + 1, values);
  } else if (node.IsMap()) {
    for (const auto& entry : node) {
      check_tree(entry.first, origin, level + 1, values);
      check_tree(entry.second, origin, level + 1, values);
    }
  }
}

YAML::Node load(const std::string& text, const std::string& origin) {
  if (!is_utf8(text)) throw Error(origin, "is no text in UTF-8", "save it as UTF-8");
  try {
    const YAML::Node node = YAML::Load(text);
    int values = 0;
    check_tree(node, origin, 0, values);
    return node;
  } catch (const YAML::Exception& error) {
    throw Error(origin + ":" + std::to_string(error.mark.line + 1), error.msg, "YAML is expected");
  }
}

}  // namespace

YamlNode::YamlNode(std::string origin, const YAML::Node& node, std::string name)
    : origin_(std::move(origin)), node_(std::make_shared<const YAML::Node>(node)), name_(std::move(name)) {}

YamlNode YamlNode::parse(const std::string& text, const std::string& origin, std::string name) {
  return {origin, load(text, origin), std::move(name)};
}

YamlNode YamlNode::read(const std::filesystem::path& path, std::string name) {
  std::string text = read_text(path);
  if (text.starts_with("%YAML:")) text.front() = '#';  // A comment.
  return parse(text, path.string(), std::move(name));
}

bool YamlNode::is_map() const { return node_->IsMap(); }
bool YamlNode::is_list() const { return node_->IsSequence(); }
bool YamlNode::is_scalar() const { return node_->IsScalar(); }
bool YamlNode::is_null() const { return node_->IsNull(); }

std::string YamlNode::where() const { return origin_ + ":" + std::to_string(std::max(0, node_->Mark().line) + 1); }

void YamlNode::fail(const std::string& problem, const std::string& remedy) const {
  throw Error(where(), "'" + name_ + "' " + problem, remedy);
}

std::string YamlNode::scalar() const {
  if (!node_->IsScalar()) fail("has no single value", "write `" + name_ + ": value`");
  return node_->Scalar();
}

std::string YamlNode::text() const {
  std::string value = scalar();
  if (value.empty()) fail("is empty", "write `" + name_ + ": text`");
  return value;
}

int YamlNode::whole_number(int least, int most) const {
  const std::string value = scalar();
  int number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || number < least || number > most) {
    fail("is '" + value + "'",
         "a whole number from " + std::to_string(least) + " to " + std::to_string(most) + " is expected");
  }
  return number;
}

double YamlNode::number() const {
  const std::string value = scalar();
  double number = 0;
  if (!parse_number(value, number) || !std::isfinite(number)) fail("is '" + value + "'", "a finite number is expected");
  return number;
}

double YamlNode::positive_number() const {
  const std::string value = scalar();
  double number = 0;
  if (!parse_number(value, number) || !std::isfinite(number) || number <= 0)
    fail("is '" + value + "'", "a number above 0 is expected");
  return number;
}

std::vector<double> YamlNode::all_numbers() const {
  if (!is_list()) fail("is no list of numbers", "write `" + name_ + ": [1, 2, ..]`");
  std::vector<double> numbers;
  for (const YAML::Node& element : *node_) {
    std::string text = child(element, name_).scalar();
    if (text.ends_with('.')) text.pop_back();  // OpenCV writes "5." for 5.
    double& number = numbers.emplace_back();
    if (!parse_number(text, number) || !std::isfinite(number)) fail("is '" + text + "'", "a finite number is expected");
  }
  return numbers;
}

std::vector<double> YamlNode::numbers(std::size_t count) const {
  std::vector<double> numbers;
  if (is_list()) numbers = all_numbers();
  if (numbers.size() != count)
    fail("is no list of " + std::to_string(count) + " numbers", "write `" + name_ + ": [1, 2, ..]`");
  return numbers;
}

bool YamlNode::yes_or_no() const {
  const std::string word = to_lower(scalar());
  if (word == "on" || word == "true" || word == "yes") return true;
  if (word != "off" && word != "false" && word != "no") fail("is '" + word + "'", "on or off is expected");
  return false;
}

std::size_t YamlNode::one_of(const std::vector<std::string>& words) const {
  const std::string word = scalar();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    fail("is '" + word + "'", joined(words) + " is expected; did you mean " + nearest_name(word, words) + "?");
  }
  return static_cast<std::size_t>(found - words.begin());
}

std::vector<YamlNode> YamlNode::elements() const {
  std::vector<YamlNode> elements;
  if (node_->IsSequence()) {
    for (const YAML::Node& element : *node_) elements.push_back(child(element, name_));
  } else if (node_->IsDefined() && !node_->IsNull()) {
    elements.push_back(*this);
  }
  if (elements.empty()) fail("is empty", "give at least one value");
  return elements;
}

std::vector<std::pair<std::string, YamlNode>> YamlNode::entries() const {
  if (!node_->IsMap()) fail("has no lines `key: value`", "see the documentation for the keys");
  std::vector<std::pair<std::string, YamlNode>> entries;
  std::set<std::string> keys;
  for (const auto& entry : *node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    const YamlNode here = child(entry.first, key);
    if (key.empty()) here.fail("is no key", "a key is a word");
    if (!keys.insert(key).second) here.fail("is set twice", "remove one of the lines");
    entries.emplace_back(key, child(entry.second, key));
  }
  return entries;
}

bool YamlNode::contains(const std::string& key) const { return is_map() && (*node_)[key].IsDefined(); }

YamlNode YamlNode::at(const std::string& key) const {
  if (!contains(key)) fail("has no '" + key + "'", "add a line `" + key + ": value`");
  return child((*node_)[key], key);
}

void YamlNode::check_key(const std::string& key, const std::vector<std::string>& names) const {
  if (std::find(names.begin(), names.end(), key) != names.end()) return;
  throw Error(where(), "unknown key '" + key + "'", "did you mean '" + nearest_name(key, names) + "'?");
}

}  // namespace ldso
