#pragma once
// `ldso eval ESTIMATE GROUNDTRUTH`: how accurate is a trajectory?

#include <CLI/CLI.hpp>

namespace ldso {

/// Adds the subcommand to `app`; it runs while the command line is parsed and throws ldso::Error on bad input.
void add_eval_command(CLI::App& app);

}  // namespace ldso
