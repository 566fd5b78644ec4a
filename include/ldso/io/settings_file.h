#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ldso/settings.h"

namespace ldso {

// Settings by name. Nested groups are maps in YAML ("selection: {candidates: 1500}") and dotted keys on the command
// line ("selection.candidates=1500"). The names are those of fields() (setting.h); others are errors.

/// Changes the settings that the file names. Throws Error naming file, line and what is allowed; for an unknown key the
/// nearest one. What has to hold between settings is not checked: call Settings::validate() when all sources have been
/// read.
void read_settings(const std::filesystem::path& path, Settings& settings);

/// All settings in the form that read_settings() reads. Throws Error if the file cannot be written.
void write_settings(const std::filesystem::path& path, const Settings& settings);

/// Sets the one that `key` names, e.g. set_setting(settings, "selection.candidates", "1500"). Throws Error likewise.
void set_setting(Settings& settings, const std::string& key, const std::string& value);

/// The same for each of `assignments`, "key=value" as `ldso run --set` takes them, in order.
void set_settings(Settings& settings, const std::vector<std::string>& assignments);

/// All dotted keys, in order.
std::vector<std::string> setting_keys();

}  // namespace ldso
