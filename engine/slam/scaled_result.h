#pragma once

#include "ldso/slam.h"

namespace ldso {

/// Puts a result into another unit: all lengths become `factor` times as large, inverse depths as much smaller. The
/// scale of a single camera is free, so that nothing else changes. Throws Error unless `factor` is positive and finite.
void scale_result(double factor, SlamResult& result);

}  // namespace ldso
