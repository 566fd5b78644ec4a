#include "ldso/io/settings_file.h"
#include "io/settings/settings_json.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <system_error>
#include <type_traits>
#include <utility>

#include "io/text/nearest_name.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

struct IgnoreField {
  template <class Value>
  void operator()(const char* /*name*/, Value& /*value*/) const {}
};

/// A type that lists fields of its own.
template <class T>
concept Group = requires(T& group) {
  T::visit_fields(group, IgnoreField{});
};

constexpr std::array<std::pair<SelectionStrategy, const char*>, 3> kStrategies{{
    {SelectionStrategy::kCorners, "corners"},
    {SelectionStrategy::kGradient, "gradient"},
    {SelectionStrategy::kRandom, "random"},
}};

// Text to value; `where` is what a complaint begins with.

[[noreturn]] void reject(const std::string& where, const std::string& text, const std::string& expected) {
  throw Error(where, "'" + text + "' is not valid", expected);
}

void parse_value(const std::string& where, const std::string& text, bool& value) {
  const std::string word = to_lower(text);
  const bool yes = word == "true" || word == "yes" || word == "on" || word == "1";
  const bool no = word == "false" || word == "no" || word == "off" || word == "0";
  if (!yes && !no) reject(where, text, "true or false is expected");
  value = yes;
}

template <std::integral Integer>
void parse_value(const std::string& where, const std::string& text, Integer& value) {
  Integer parsed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error != std::errc() || end != text.data() + text.size()) reject(where, text, "a whole number is expected");
  value = parsed;
}

template <std::floating_point Real>
void parse_value(const std::string& where, const std::string& text, Real& value) {
  double parsed = 0;
  if (!parse_number(text, parsed) || !std::isfinite(parsed)) reject(where, text, "a finite number is expected");
  value = static_cast<Real>(parsed);
}

template <std::same_as<std::string> Text>
void parse_value(const std::string& /*where*/, const std::string& text, Text& value) {
  value = text;
}

void parse_value(const std::string& where, const std::string& text, SelectionStrategy& value) {
  for (const auto& [strategy, name] : kStrategies) {
    if (to_lower(text) != name) continue;
    value = strategy;
    return;
  }
  reject(where, text, "corners, gradient or random is expected");
}

// Value to text and JSON.

const char* name_of(SelectionStrategy value) {
  for (const auto& [strategy, name] : kStrategies) {
    if (strategy == value) return name;
  }
  return "unknown";
}

template <class T>
nlohmann::json to_json_value(const T& value) {
  if constexpr (std::is_same_v<T, SelectionStrategy>) {
    return name_of(value);
  } else {
    return value;
  }
}

template <class T>
std::string to_text(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    std::array<char, 64> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return std::string(buffer.data(), end);  // The shortest text that reads back as the same number.
  } else if constexpr (std::is_same_v<T, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_same_v<T, SelectionStrategy>) {
    return name_of(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return nlohmann::json(value).dump();  // A JSON string is a YAML string.
  } else {
    return std::to_string(value);
  }
}

template <class T>
std::vector<std::string> field_names(T& group) {
  std::vector<std::string> names;
  T::visit_fields(group, [&](const char* name, auto& /*value*/) { names.emplace_back(name); });
  return names;
}

template <class T>
[[noreturn]] void reject_key(const std::string& where, const std::string& prefix, const std::string& key, T& group) {
  const std::string nearest = nearest_name(key, field_names(group));
  throw Error(where, "unknown setting '" + prefix + key + "'", "did you mean '" + prefix + nearest + "'?");
}

class YamlReader {
 public:
  explicit YamlReader(const std::filesystem::path& path) : path_(path) {}

  template <class T>
  void read_group(const YAML::Node& node, const std::string& prefix, T& group) const {
    if (!node.IsMap()) throw Error(where(node), "'" + prefix + "' is not a group", "settings are lines `name: value`");
    std::vector<std::string> seen;
    for (const auto& entry : node) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        throw Error(where(entry.first), std::string("'").append(prefix).append(key).append("' is set twice"),
                    "remove one of the lines");
      }
      seen.push_back(key);
      bool known = false;
      T::visit_fields(group, [&](const char* name, auto& value) {
        if (key != name) return;
        known = true;
        read_field(entry.second, prefix + key, value);
      });
      if (!known) reject_key(where(entry.first), prefix, key, group);
    }
  }

 private:
  template <class T>
  void read_field(const YAML::Node& node, const std::string& key, T& value) const {
    if constexpr (Group<T>) {
      read_group(node, key + ".", value);
    } else {
      if (!node.IsScalar()) throw Error(where(node), "'" + key + "' has no single value", "expected `name: value`");
      parse_value(where(node) + ": " + key, node.Scalar(), value);
    }
  }

  std::string where(const YAML::Node& node) const {
    return path_.string() + ":" + std::to_string(node.Mark().line + 1);
  }

  std::filesystem::path path_;
};

template <class T>
void set_field(T& group, const std::string& prefix, const std::string& rest, const std::string& text) {
  const std::size_t dot = rest.find('.');
  const std::string head = rest.substr(0, dot);
  const std::string tail = dot == std::string::npos ? "" : rest.substr(dot + 1);
  bool known = false;
  T::visit_fields(group, [&](const char* name, auto& value) {
    if (head != name) return;
    known = true;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (Group<Value>) {
      if (tail.empty())
        throw Error(prefix + head, "is a group of settings", "name one of them: " + prefix + head + ".name");
      set_field(value, prefix + head + ".", tail, text);
    } else {
      if (!tail.empty()) throw Error(prefix + rest, "'" + prefix + head + "' is no group of settings", "");
      parse_value(prefix + head, text, value);
    }
  });
  if (!known) reject_key("settings", prefix, head, group);
}

/// Calls visit(dotted key, value) for every setting that is no group.
template <class T, class Visitor>
void visit_leaves(T& group, const std::string& prefix, Visitor& visit) {
  std::remove_const_t<T>::visit_fields(group, [&](const char* name, auto& value) {
    if constexpr (Group<std::remove_cvref_t<decltype(value)>>) {
      visit_leaves(value, prefix + name + ".", visit);
    } else {
      visit(prefix + name, value);
    }
  });
}

template <class T>
void write_group(const T& group, const std::string& indent, std::string& text) {
  T::visit_fields(group, [&](const char* name, const auto& value) {
    if constexpr (Group<std::remove_cvref_t<decltype(value)>>) {
      text += indent + name + ":\n";
      write_group(value, indent + "  ", text);
    } else {
      text += indent + name + ": " + to_text(value) + "\n";
    }
  });
}

template <class T>
nlohmann::json group_to_json(const T& group) {
  nlohmann::json json = nlohmann::json::object();
  T::visit_fields(group, [&](const char* name, const auto& value) {
    if constexpr (Group<std::remove_cvref_t<decltype(value)>>) {
      json[name] = group_to_json(value);
    } else {
      json[name] = to_json_value(value);
    }
  });
  return json;
}

}  // namespace

void read_settings(const std::filesystem::path& path, Settings& settings) {
  YAML::Node node;
  try {
    node = YAML::Load(read_file(path));
  } catch (const YAML::Exception& error) {
    throw Error(path.string() + ":" + std::to_string(error.mark.line + 1), error.msg, "YAML is expected");
  }
  Settings changed = settings;  // All or nothing.
  if (!node.IsNull()) YamlReader(path).read_group(node, "", changed);
  settings = changed;
}

void write_settings(const std::filesystem::path& path, const Settings& settings) {
  std::string text;
  write_group(settings, "", text);
  write_file(path, text);
}

void set_setting(Settings& settings, const std::string& key, const std::string& value) {
  set_field(settings, "", key, value);
}

std::vector<std::string> setting_keys() {
  const Settings settings;
  std::vector<std::string> keys;
  auto collect = [&](const std::string& key, const auto& /*value*/) { keys.push_back(key); };
  visit_leaves(settings, "", collect);
  return keys;
}

nlohmann::json settings_to_json(const Settings& settings) { return group_to_json(settings); }

}  // namespace ldso
