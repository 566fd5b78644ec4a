#pragma once
// `ldso experiment demo`: renders stand-ins for the benchmarks and runs a plan on them.

#include <CLI/CLI.hpp>

namespace ldso {

void add_experiment_demo_command(CLI::App& experiment, int& exit_code);

}  // namespace ldso
