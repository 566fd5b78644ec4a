#pragma once

// Settings by name, and a part of them: settings["window.iterations"], settings.window.iterations.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "ldso/settings.h"

namespace ldso::python {

/// All settings, or the group of them whose keys begin with `prefix` ("window.").
struct SettingsView {
  std::shared_ptr<Settings> settings = std::make_shared<Settings>();
  std::string prefix;
};

/// From a ldso.Settings, a dict of names (nested or dotted) and values, or None. Throws Error if a name or value is
/// wrong, or if the settings contradict each other.
Settings to_settings(const pybind11::object& given);

/// Sets each of a dict, nested or dotted, below `prefix`.
void update_settings(Settings& settings, const pybind11::dict& values, const std::string& prefix);

}  // namespace ldso::python
