#pragma once
// `ldso experiment compare`: what got better or worse between two experiments.

#include <CLI/CLI.hpp>

namespace ldso {

/// Exit code if the second experiment is worse than the limits allow.
inline constexpr int kLossExitCode = 3;

/// Adds the subcommand to `experiment`. It sets `exit_code`, which must outlive the parsing.
void add_compare_command(CLI::App& experiment, int& exit_code);

}  // namespace ldso
