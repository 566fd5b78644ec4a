#pragma once
// `ldso export OUT`: the map and the trajectory of a finished run in the formats of other programs.

#include <CLI/CLI.hpp>

namespace ldso {

/// Adds the subcommand to `app`; it runs while the command line is parsed and throws ldso::Error on bad input.
void add_export_command(CLI::App& app);

}  // namespace ldso
