#pragma once

// All settings with what is declared of them, for people (a table, docs/settings.md) and programs (JSON).

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ldso/settings.h"

namespace ldso {

/// A setting or, without default, the group that those after it belong to.
struct SettingRow {
  std::string key = {};
  std::string default_text = {};  ///< As in a file. Empty: a group.
  std::string allowed = {};       ///< "1 to 100 px", "corners, gradient or random".
  std::string source = {};        ///< Of the default.
  std::string sentence = {};
  bool expert = false;
};

/// In the order of their declaration; groups come before their settings.
std::vector<SettingRow> setting_rows();

/// A table for a terminal; without those for experts unless wanted.
std::string settings_table(bool expert);

/// docs/settings.md.
std::string settings_markdown();

/// {key: {default, type, least, largest, unit, choices, source, sentence, expert}}; what does not apply is left out.
nlohmann::ordered_json settings_list_json(bool expert);

}  // namespace ldso
