#pragma once
// `ldso view OUT`: a finished run in the browser.

#include <CLI/CLI.hpp>

namespace ldso {

/// Adds the subcommand to `app`; it runs while the command line is parsed and throws ldso::Error on bad input.
void add_view_command(CLI::App& app);

}  // namespace ldso
