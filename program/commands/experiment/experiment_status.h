#pragma once
// `ldso experiment status`: which jobs have ended and how.

#include <CLI/CLI.hpp>

namespace ldso {

void add_experiment_status_command(CLI::App& experiment);

}  // namespace ldso
