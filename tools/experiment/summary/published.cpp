#include "experiment/summary/published.h"

#include <yaml-cpp/yaml.h>

#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {

/// experiments/published.yaml; CMakeLists.txt makes it a source file.
extern const char kPublishedText[];

namespace {

[[noreturn]] void fail(const std::string& where, const YAML::Mark& mark, const std::string& problem) {
  std::string place = where;
  if (!mark.is_null()) place.append(":").append(std::to_string(mark.line + 1));
  throw Error(place, problem, "see experiments/published.yaml for the form");
}

PublishedResults results_of(const std::string& where, const YAML::Node& node) {
  static const std::set<std::string> kRequired = {"system", "source", "dataset", "figure", "unit", "values"};
  if (!node.IsMap()) fail(where, node.Mark(), "a system with its values is expected");
  for (const auto& member : node) {
    const std::string name = member.first.as<std::string>();
    if (!kRequired.contains(name) && name != "frames") fail(where, member.first.Mark(), "unknown member " + name);
  }
  for (const std::string& name : kRequired) {
    if (!node[name]) fail(where, node.Mark(), "the member " + name + " is missing");
  }
  PublishedResults results;
  results.system = node["system"].as<std::string>();
  results.source = node["source"].as<std::string>();
  results.dataset = node["dataset"].as<std::string>();
  results.figure = node["figure"].as<std::string>();
  results.unit = node["unit"].as<std::string>();
  for (const auto& value : node["values"]) {
    const auto key = value.first.as<std::string>();
    if (value.second.IsScalar() && value.second.as<std::string>() == "failed") {
      results.values[key] = std::nullopt;
    } else {
      results.values[key] = value.second.as<double>();
    }
  }
  for (const auto& frames : node["frames"]) results.frames[frames.first.as<std::string>()] = frames.second.as<double>();
  return results;
}

std::vector<PublishedResults> parse(const std::string& where, const std::string& text) {
  std::vector<PublishedResults> all;
  try {
    for (const YAML::Node& node : YAML::Load(text)) all.push_back(results_of(where, node));
  } catch (const YAML::Exception& error) {
    fail(where, error.mark, error.msg);
  }
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
