#include "ldso/io/settings_file.h"

#include <charconv>
#include <cmath>
#include <concepts>
#include <set>
#include <system_error>
#include <type_traits>
#include <utility>

#include "io/settings/presets.h"
#include "io/settings/setting_text.h"
#include "io/text/nearest_name.h"
#include "io/text/text_file.h"
#include "io/text/yaml_node.h"
#include "ldso/error.h"
#include "settings/setting_range.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr const char* kPresetKey = "preset";

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

void parse_value(const std::string& where, const std::string& text, double& value) {
  double parsed = 0;
  if (!parse_number(text, parsed) || !std::isfinite(parsed)) reject(where, text, "a finite number is expected");
  value = parsed;
}

void parse_value(const std::string& /*where*/, const std::string& text, std::string& value) { value = text; }

template <SettingChoice Choice>
void parse_value(const std::string& where, const std::string& text, Choice& value) {
  for (const auto& [choice, word] : choices(value)) {
    if (to_lower(text) != word) continue;
    value = choice;
    return;
  }
  reject(where, text, choice_text<Choice>() + " is expected");
}

/// As above, held to the setting's range.
template <class Value>
void parse_setting(const std::string& where, const std::string& text, const SettingInfo& info, Value& value) {
  Value parsed = value;
  parse_value(where, text, parsed);
  if constexpr (SettingNumber<Value>) check_range(where, static_cast<double>(parsed), info);
  value = parsed;
}

// Keys.

/// Calls act(value, info) for the group's field of this name; false if there is none.
template <class Group, class Act>
bool with_field(Group& group, const std::string& name, const Act& act) {
  bool found = false;
  for_each_field(group, [&](auto& value, const SettingInfo& info) {
    if (info.name != name) return;
    found = true;
    act(value, info);
  });
  return found;
}

std::string last_word(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Keys of all settings and of the groups that they are in.
std::vector<std::string> known_keys() {
  std::vector<std::string> keys = setting_keys();
  keys.emplace_back(kPresetKey);
  std::set<std::string> groups;
  for (const std::string& key : keys) {
    for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1))
      groups.insert(key.substr(0, dot));
  }
  keys.insert(keys.end(), groups.begin(), groups.end());
  return keys;
}

/// The key that is most like an unknown one: of those with its last word, or else of all. (Who knows the name may not
/// know the group.)
std::string nearest_key(const std::string& key) {
  const std::vector<std::string> all = known_keys();
  std::vector<std::string> likely;
  for (const std::string& known : all) {
    if (last_word(known) == last_word(key)) likely.push_back(known);
  }
  return nearest_name(key, likely.empty() ? all : likely);
}

[[noreturn]] void reject_key(const std::string& where, const std::string& key) {
  throw Error(where, "unknown setting '" + key + "'", "did you mean '" + nearest_key(key) + "'?");
}

template <class Group>
void read_group(const YamlNode& node, const std::string& prefix, Group& group);

/// Of a key of one group: a setting or a group of them.
template <class Value>
void read_field(const YamlNode& node, const std::string& key, const SettingInfo& info, Value& value) {
  if constexpr (SettingGroup<Value>) {
    read_group(node, key + ".", value);
  } else {
    if (!node.is_scalar()) throw Error(node.where(), "'" + key + "' has no single value", "expected `name: value`");
    parse_setting(node.where() + ": " + key, node.scalar(), info, value);
  }
}

template <class Group>
void read_group(const YamlNode& node, const std::string& prefix, Group& group) {
  if (!node.is_map()) throw Error(node.where(), "'" + prefix + "' is not a group", "settings are lines `name: value`");
  for (const auto& [name, entry] : node.entries()) {
    const std::string key = prefix + name;
    if (key == kPresetKey) continue;
    const bool known = with_field(
        group, name, [&, &at = entry](auto& value, const SettingInfo& info) { read_field(at, key, info, value); });
    if (!known) reject_key(entry.where(), key);
  }
}

/// The one that the file names counts before all else that it says.
void read_preset(const YamlNode& node, Settings& settings) {
  if (!node.is_map()) return;
  for (const auto& [name, entry] : node.entries()) {
    if (name != kPresetKey) continue;
    if (!entry.is_scalar()) throw Error(entry.where(), "'preset' has no single value", "expected `preset: fast`");
    apply_preset(entry.where(), entry.scalar(), settings);
  }
}

template <class Group>
void set_field(Group& group, const std::string& prefix, const std::string& rest, const std::string& text) {
  const std::size_t dot = rest.find('.');
  const std::string key = prefix + rest.substr(0, dot), tail = dot == std::string::npos ? "" : rest.substr(dot + 1);
  const bool known = with_field(group, rest.substr(0, dot), [&](auto& value, const SettingInfo& info) {
    if constexpr (SettingGroup<std::remove_cvref_t<decltype(value)>>) {
      if (tail.empty()) throw Error(key, "is a group of settings", "name one of them: " + key + ".name");
      set_field(value, key + ".", tail, text);
    } else {
      if (!tail.empty()) throw Error(prefix + rest, "'" + key + "' is no group of settings", "");
      parse_setting("setting " + key, text, info, value);
    }
  });
  if (!known) reject_key("settings", prefix + rest);
}

template <class Group>
void write_group(const Group& group, const std::string& indent, std::string& text) {
  for_each_field(group, [&](const auto& value, const SettingInfo& info) {
    text.append(indent).append(info.name).append(":");
    if constexpr (SettingGroup<std::remove_cvref_t<decltype(value)>>) {
      text += "\n";
      write_group(value, indent + "  ", text);
    } else {
      text += " " + setting_text(value) + "\n";
    }
  });
}

}  // namespace

void read_settings(const std::filesystem::path& path, Settings& settings) {
  const YamlNode node = YamlNode::read(path, "the settings");
  Settings changed = settings;  // All or nothing.
  read_preset(node, changed);
  if (!node.is_null()) read_group(node, "", changed);
  settings = changed;
}

void write_settings(const std::filesystem::path& path, const Settings& settings) {
  std::string text;
  write_group(settings, "", text);
  write_file(path, text);
}

void set_setting(Settings& settings, const std::string& key, const std::string& value) {
  if (key == kPresetKey) return apply_preset("setting preset", value, settings);
  set_field(settings, "", key, value);
}

void set_settings(Settings& settings, const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Error("--set " + assignment, "has no value", "write --set key=value");
    set_setting(settings, assignment.substr(0, equals), assignment.substr(equals + 1));
  }
}

std::vector<std::string> setting_keys() {
  const Settings settings;
  std::vector<std::string> keys;
  for_each_setting(settings,
                   [&](const std::string& key, const auto& /*value*/, const SettingInfo&) { keys.push_back(key); });
  return keys;
}

}  // namespace ldso
