#pragma once
// What is wrong with the times of a sequence's frames.

#include <vector>

#include "doctor/finding.h"

namespace ldso {

/// Times that do not grow, gaps where frames are missing, a rate too low to be tracked.
/// `times`: of all frames in the order in which they are played [s]; in reverse they may decrease.
Findings time_findings(const std::vector<double>& times);

}  // namespace ldso
