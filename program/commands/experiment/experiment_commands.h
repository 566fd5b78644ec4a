#pragma once
// `ldso experiment`: plans of many runs, their jobs and what comes of them. What it can do is one a file; see
// commands.h.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace ldso {

/// Exit code if the second of two compared experiments is worse than the limits allow.
inline constexpr int kLossExitCode = 3;

/// With all that follows.
void add_experiment_command(CLI::App& app, int& exit_code);
/// The command line with `ldso experiment PLAN ...` written out as `ldso experiment run PLAN ...`, and `--demo` as
/// `demo`.
std::vector<std::string> without_experiment_shorthands(std::vector<std::string> arguments, const CLI::App& app);

/// All jobs of a plan that have no result yet.
void add_experiment_run_command(CLI::App& experiment, int& exit_code);
/// Which jobs have ended and how.
void add_experiment_status_command(CLI::App& experiment);
/// Figures and tables of an experiment from what is finished.
void add_experiment_summarize_command(CLI::App& experiment);
/// What got better or worse between two experiments. Ends with kLossExitCode.
void add_experiment_compare_command(CLI::App& experiment, int& exit_code);
/// Renders stand-ins for the benchmarks and runs a plan on them.
void add_experiment_demo_command(CLI::App& experiment, int& exit_code);

/// Writes all figures and tables into `<experiment>/summary`, for the end of a plan. Prints the tables and where all of
/// it is, warnings only if `quiet`.
void summarize_experiment(const std::filesystem::path& experiment, bool quiet);

}  // namespace ldso
