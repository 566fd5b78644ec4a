#pragma once
// What `ldso calibrate` does beside the lens, one a file; see commands.h.

#include <CLI/CLI.hpp>

namespace ldso {

/// `ldso calibrate photometric`: response and vignette.
void add_photometric_command(CLI::App& calibrate);

}  // namespace ldso
