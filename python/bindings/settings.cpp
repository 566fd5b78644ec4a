#include "bindings/settings.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "bindings/bindings.h"
#include "ldso/error.h"
#include "ldso/io/settings_file.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

bool begins_with(const std::string& text, const std::string& beginning) { return text.rfind(beginning, 0) == 0; }

/// As the command line would have it.
std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  return py::str(value);
}

template <class T>
py::object value_of(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return py::str(std::string(word_of(value)));
  } else {
    return py::cast(value);
  }
}

/// The value with this key; nothing if there is none.
std::optional<py::object> find_setting(const Settings& settings, const std::string& key) {
  std::optional<py::object> found;
  for_each_setting(settings, [&](const std::string& name, const auto& value, const SettingInfo&) {
    if (name == key) found = value_of(value);
  });
  return found;
}

bool has_group(const std::string& prefix) {
  for (const std::string& key : setting_keys()) {
    if (begins_with(key, prefix)) return true;
  }
  return false;
}

/// A value or a group. Throws Error naming the nearest name.
py::object get_setting(const SettingsView& view, const std::string& name) {
  const std::string key = view.prefix + name;
  if (const auto value = find_setting(*view.settings, key)) return *value;
  if (has_group(key + ".")) return py::cast(SettingsView{view.settings, key + "."});
  Settings unused;
  set_setting(unused, key, "");  // Throws: there is no such setting.
  return py::none();
}

void set_below(SettingsView& view, const std::string& name, const py::object& value) {
  const std::string key = view.prefix + name;
  if (py::isinstance<py::dict>(value)) {
    update_settings(*view.settings, value, key + ".");
  } else {
    set_setting(*view.settings, key, text_of(value));
  }
}

/// Names just below a group, in order.
std::vector<std::string> names_below(const SettingsView& view) {
  std::vector<std::string> names;
  for (const std::string& key : setting_keys()) {
    if (!begins_with(key, view.prefix)) continue;
    std::string name = key.substr(view.prefix.size());
    name = name.substr(0, name.find('.'));
    if (names.empty() || names.back() != name) names.push_back(std::move(name));
  }
  return names;
}

py::dict settings_dict(const SettingsView& view) {
  py::dict dict;
  for_each_setting(*view.settings, [&](const std::string& key, const auto& value, const SettingInfo&) {
    if (begins_with(key, view.prefix)) dict[py::str(key.substr(view.prefix.size()))] = value_of(value);
  });
  return dict;
}

SettingsView make_settings(const std::optional<py::dict>& values, const py::kwargs& more) {
  SettingsView view;
  if (values) update_settings(*view.settings, *values, "");
  update_settings(*view.settings, more, "");
  return view;
}

SettingsView read_settings_file(const std::filesystem::path& path) {
  SettingsView view;
  read_settings(path, *view.settings);
  return view;
}

}  // namespace

void update_settings(Settings& settings, const py::dict& values, const std::string& prefix) {
  for (const auto& [name, value] : values) {
    const std::string key = prefix + std::string(py::str(name));
    if (py::isinstance<py::dict>(value)) {
      update_settings(settings, py::reinterpret_borrow<py::dict>(value), key + ".");
    } else {
      set_setting(settings, key, text_of(value));
    }
  }
}

Settings to_settings(const py::object& given) {
  Settings settings;
  if (py::isinstance<SettingsView>(given)) {
    settings = *given.cast<const SettingsView&>().settings;
  } else if (py::isinstance<py::dict>(given)) {
    update_settings(settings, given, "");
  } else if (!given.is_none()) {
    throw Error("settings", "they are neither ldso.Settings nor a dict", "pass ldso.Settings(threads=2), for instance");
  }
  settings.validate();
  return settings;
}

void bind_settings(py::module_& module) {
  py::class_<SettingsView>(module, "Settings",
                           "All settings with their defaults; docs/settings.md and `ldso settings` list them. They are "
                           "read and set by dotted name, settings[\"window.iterations\"] = 8, or by attribute, "
                           "settings.window.iterations = 8. A wrong name or value is an ldso.Error.")
      .def(py::init(&make_settings), "values"_a = py::none(),
           "From a dict and keywords, nested or dotted: Settings(threads=1, loops={\"enabled\": False}).")
      .def_static("read", &read_settings_file, "path"_a, "Defaults changed by a YAML file.")
      .def(
          "write", [](const SettingsView& v, const std::filesystem::path& path) { write_settings(path, *v.settings); },
          "path"_a, "All settings as YAML.")
      .def(
          "update", [](SettingsView& v, const py::dict& values) { update_settings(*v.settings, values, v.prefix); },
          "values"_a, "Change those that a dict names, nested or dotted.")
      .def("to_dict", &settings_dict, "Dotted names and values.")
      .def("copy",
           [](const SettingsView& v) {
             return SettingsView{std::make_shared<Settings>(*v.settings), v.prefix};
           })
      .def("__getitem__", &get_setting)
      .def("__setitem__", &set_below)
      .def("__getattr__",
           [](const SettingsView& v, const std::string& name) {
             try {
               return get_setting(v, name);
             } catch (const Error& error) {
               throw py::attribute_error(error.what());
             }
           })
      .def("__setattr__", &set_below)
      .def("__dir__", &names_below)
      .def("__repr__",
           [](const SettingsView& v) { return "<ldso.Settings " + std::string(py::repr(settings_dict(v))) + ">"; });
}

}  // namespace ldso::python
