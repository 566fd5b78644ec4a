#pragma once
// The command line as a whole: what subcommands and main() share about errors in it.

#include <CLI/CLI.hpp>

namespace ldso {

/// Parses and runs the subcommand. Errors of the command line are printed with the nearest name, as are those that the
/// subcommand throws. Returns the exit code: 0 or 1; `exit_code` if a subcommand set it to something else.
int run_command_line(CLI::App& app, int argc, const char* const* argv, const int& exit_code);

}  // namespace ldso
