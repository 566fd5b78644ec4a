#include "experiment/summary/published.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "io/text/yaml_node.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {

/// experiments/published.yaml; CMakeLists.txt makes it a source file.
extern const char kPublishedText[];

namespace {

constexpr const char* kForm = "see experiments/published.yaml for the form";

PublishedResults results_of(const YamlNode& node) {
  static const std::vector<std::string> kRequired = {"system", "source", "dataset", "figure", "unit", "values"};
  if (!node.is_map()) node.fail("is no system with its values", kForm);
  for (const auto& [key, value] : node.entries()) {
    const bool known = key == "frames" || std::find(kRequired.begin(), kRequired.end(), key) != kRequired.end();
    if (!known) throw Error(value.where(), "unknown member " + key, kForm);
  }
  for (const std::string& key : kRequired) {
    if (!node.contains(key)) throw Error(node.where(), "the member " + key + " is missing", kForm);
  }
  PublishedResults results;
  results.system = node.at("system").scalar();
  results.source = node.at("source").scalar();
  results.dataset = node.at("dataset").scalar();
  results.figure = node.at("figure").scalar();
  results.unit = node.at("unit").scalar();
  for (const auto& [key, value] : node.at("values").entries()) {
    results.values[key] = value.scalar() == "failed" ? std::nullopt : std::optional(value.number());
  }
  if (!node.contains("frames")) return results;
  for (const auto& [key, value] : node.at("frames").entries()) results.frames[key] = value.number();
  return results;
}

std::vector<PublishedResults> parse(const std::string& where, const std::string& text) {
  std::vector<PublishedResults> all;
  for (const YamlNode& node : YamlNode::parse(text, where, "a system").elements()) all.push_back(results_of(node));
  return all;
}

/// Whether `name` is `key`, perhaps with words before or after it: no letter or digit touches it.
bool contains_word(const std::string& name, const std::string& key) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = name.find(key); at != std::string::npos; at = name.find(key, at + 1)) {
    const std::size_t end = at + key.size();
    if ((at == 0 || !is_part(name[at - 1])) && (end == name.size() || !is_part(name[end]))) return true;
  }
  return false;
}

}  // namespace

std::optional<double> PublishedResults::value_of(const std::string& sequence,
                                                 const std::optional<double>& frames_of_ours) const {
  auto found = values.find(sequence);
  for (auto it = values.begin(); found == values.end() && it != values.end(); ++it) {
    if (contains_word(sequence, it->first)) {
      found = it;
      break;
    }
  }
  if (found == values.end()) return std::nullopt;
  const auto known = frames.find(found->first);
  if (frames_of_ours && known != frames.end() &&
      std::abs(*frames_of_ours - known->second) > kSameFrames * known->second) {
    return std::nullopt;
  }
  return found->second.value_or(std::numeric_limits<double>::infinity());
}

std::vector<PublishedResults> read_published(const std::filesystem::path& path) {
  return parse(path.string(), read_file(path));
}

std::vector<PublishedResults> built_in_published() { return parse("built-in published.yaml", kPublishedText); }

}  // namespace ldso
