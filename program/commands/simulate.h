#pragma once
// `ldso simulate WORLD -o DIR`: renders a sequence with exact ground truth.

#include <CLI/CLI.hpp>

namespace ldso {

/// Adds the subcommand to `app`; it runs while the command line is parsed and throws ldso::Error on bad input.
void add_simulate_command(CLI::App& app);

}  // namespace ldso
