#pragma once
// The options by which one known length makes a map metric.

#include <CLI/CLI.hpp>

#include "scaling/metric_scale.h"

namespace ldso {

/// --scale, --scale-tag and --scale-height, of which one can be given. `request` must outlive the parsing.
void add_scale_options(CLI::App& command, ScaleRequest& request);

}  // namespace ldso
