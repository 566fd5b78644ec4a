#pragma once
// `ldso experiment`: plans of many runs, their jobs and what comes of them.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace ldso {

/// `exit_code` is set by runs that are interrupted.
void add_experiment_command(CLI::App& app, int& exit_code);

/// The command line with `ldso experiment PLAN ..` written out as `ldso experiment run PLAN ..`, and `--demo` as
/// `demo`.
std::vector<std::string> without_experiment_shorthands(std::vector<std::string> arguments, const CLI::App& app);

}  // namespace ldso
