#include "io/settings/settings_list.h"

#include <algorithm>
#include <concepts>
#include <type_traits>
#include <utility>

#include "io/settings/presets.h"
#include "io/settings/setting_text.h"
#include "settings/setting_range.h"

namespace ldso {
namespace {

template <class Value>
std::string values_text(const SettingInfo& info) {
  if constexpr (SettingChoice<Value>) {
    return choice_text<Value>();
  } else if constexpr (SettingNumber<Value>) {
    return (std::integral<Value> ? "whole, " : "") + allowed_text(info);
  } else {
    return std::same_as<Value, bool> ? "true or false" : "text";
  }
}

template <class Group>
void add_rows(const Group& group, const std::string& prefix, bool expert, std::vector<SettingRow>& rows) {
  for_each_field(group, [&](const auto& value, const SettingInfo& info) {
    using Value = std::remove_cvref_t<decltype(value)>;
    SettingRow row{.key = prefix + std::string(info.name),
                   .sentence = std::string(info.sentence),
                   .expert = expert || info.expert};
    if constexpr (SettingGroup<Value>) {
      rows.push_back(row);
      add_rows(value, row.key + ".", row.expert, rows);
    } else {
      row.default_text = setting_text(value);
      row.allowed = values_text<Value>(info);
      row.source = info.source;
      rows.push_back(row);
    }
  });
}

/// Of ASCII, as names and numbers are.
std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

template <class Value>
nlohmann::ordered_json description(const Value& value, const SettingInfo& info) {
  nlohmann::ordered_json json;
  if constexpr (SettingChoice<Value>) {
    json["default"] = std::string(word_of(value));
    json["type"] = "choice";
    for (const auto& [choice, word] : choices(value)) json["choices"].push_back(std::string(word));
  } else {
    json["default"] = value;
    json["type"] = std::same_as<Value, bool>          ? "switch"
                   : std::same_as<Value, std::string> ? "text"
                   : std::integral<Value>             ? "integer"
                                                      : "number";
  }
  if constexpr (SettingNumber<Value>) {
    json["least"] = info.least;
    json["largest"] = info.largest;
    if (!info.unit.empty()) json["unit"] = std::string(info.unit);
  }
  json["source"] = std::string(info.source);
  json["sentence"] = std::string(info.sentence);
  json["expert"] = info.expert;
  return json;
}

constexpr const char* kMarkdownHead = R"(# Settings

<!-- Made by `ldso settings --markdown`; a test compares. Change include/ldso/*settings.h instead. -->

In C++ `settings.window.iterations = 8`, on the command line `--set window.iterations=8`, in a file for `--config`

    window:
      iterations: 8

`ldso settings` prints this list, without those marked *expert* unless `--expert` is given: these are rarely worth a
change. Where the default is from: a paper (DSO is Engel et al., PAMI 2018; LDSO is Gao et al., IROS 2018), *measured*
by comparing results over sequences, or *chosen* by judgement. Defaults and ranges are in the unit of the range.
)";

std::string presets_markdown() {
  std::string text =
      "\n`--set preset=NAME` (in a file `preset: NAME`) sets several at once; what is set after it, or beside it in a "
      "file,\nholds in its stead.\n\n| preset | | settings |\n|---|---|---|\n";
  for (const Preset& preset : presets()) {
    text += "| `" + std::string(preset.name) + "` | " + std::string(preset.help) + " |";
    for (const auto& [key, value] : preset.settings) text += " `" + key + "=" + value + "`";
    text += " |\n";
  }
  return text;
}

std::string presets_table() {
  std::string text = "\npreset: several settings at once\n";
  for (const Preset& preset : presets())
    text += "  " + padded(std::string(preset.name), 8) + "  " + std::string(preset.help) + "\n";
  return text;
}

constexpr const char* kTableHead = "\n| setting | default | allowed | source | |\n|---|---|---|---|---|\n";

}  // namespace

std::vector<SettingRow> setting_rows() {
  std::vector<SettingRow> rows;
  add_rows(Settings{}, "", false, rows);
  return rows;
}

std::string settings_table(bool expert) {
  std::vector<SettingRow> rows = setting_rows();
  if (!expert) std::erase_if(rows, [](const SettingRow& row) { return row.expert; });
  std::size_t key_width = 0, default_width = 0, allowed_width = 0;
  for (const SettingRow& row : rows) {
    if (row.default_text.empty()) continue;
    key_width = std::max(key_width, row.key.size());
    default_width = std::max(default_width, row.default_text.size());
    allowed_width = std::max(allowed_width, row.allowed.size());
  }
  std::string text, heading;  // A group without settings (all are for experts) has no heading.
  for (const SettingRow& row : rows) {
    if (row.default_text.empty()) {
      heading = "\n" + row.key + ": " + row.sentence + "\n";
    } else {
      text += std::exchange(heading, "");
      text += "  " + padded(row.key, key_width) + "  " + padded(row.default_text, default_width) + "  " +
              padded(row.allowed, allowed_width) + "  " + row.sentence + "\n";
    }
  }
  return text + presets_table();
}

std::string settings_markdown() {
  std::string text = kMarkdownHead;
  text += presets_markdown();
  text += kTableHead;
  for (const SettingRow& row : setting_rows()) {
    if (row.default_text.empty()) {
      text += "\n## " + row.key + "\n\n" + row.sentence + "\n" + kTableHead;
    } else {
      text += "| `" + row.key + "` | `" + row.default_text + "` | " + row.allowed + " | " + row.source + " | " +
              row.sentence + (row.expert ? " *Expert.*" : "") + " |\n";
    }
  }
  return text;
}

nlohmann::ordered_json settings_list_json(bool expert) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const Settings defaults;
  for_each_setting(defaults, [&](const std::string& key, const auto& value, const SettingInfo& info) {
    if (expert || !info.expert) json[key] = description(value, info);
  });
  return json;
}

}  // namespace ldso
