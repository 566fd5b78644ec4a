#pragma once
// The options of commands that play a sequence.

#include <CLI/CLI.hpp>

#include "ldso/io/dataset.h"

namespace ldso {

/// --start, --end, --stride, --reverse, --calib, --fps, --pattern, --topic and --mask. `options` must outlive the
/// parsing.
void add_dataset_options(CLI::App& command, DatasetOptions& options);

}  // namespace ldso
