#pragma once
// `ldso run SEQUENCE -o OUT`: images to a trajectory and a map.

#include <CLI/CLI.hpp>

namespace ldso {

/// Nothing was tracked in the whole sequence; results are written all the same.
inline constexpr int kNothingTrackedExitCode = 2;

/// Adds the subcommand to `app`; it runs while the command line is parsed, throws ldso::Error on bad input and sets
/// `exit_code`, which must outlive the parsing, to kNothingTrackedExitCode or kInterruptedExitCode if that is so.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace ldso
