#pragma once
// The ground truth beside a run while it goes on.

#include "ldso/io/dataset.h"
#include "viewer/live_run.h"

namespace ldso {

/// If the sequence has one. A ground truth that cannot be read counts as none: the evaluation will say so.
void add_truth(const Dataset& dataset, LiveRunOptions& options);

}  // namespace ldso
