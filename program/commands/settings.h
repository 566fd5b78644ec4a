#pragma once
// `ldso settings`: all settings with defaults, ranges and what they are.

#include <CLI/CLI.hpp>

namespace ldso {

void add_settings_command(CLI::App& app);

}  // namespace ldso
