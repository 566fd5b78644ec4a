#pragma once
// `ldso experiment summarize`: figures and tables of an experiment from what is finished.

#include <CLI/CLI.hpp>
#include <filesystem>

namespace ldso {

/// Adds the subcommand to `experiment`.
void add_summarize_command(CLI::App& experiment, int& exit_code);

/// Writes all figures and tables into `<experiment>/summary`, for the end of a plan. Prints the tables and where all of
/// it is, warnings only if `quiet`.
void summarize_experiment(const std::filesystem::path& experiment, bool quiet);

}  // namespace ldso
