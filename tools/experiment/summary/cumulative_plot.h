#pragma once
// Cumulative error curves: how many runs have an error below x (as the paper's Figs. 5 and 7). Higher and further left
// is better; failed runs never come.

#include <string>

#include "experiment/results/run_groups.h"

namespace ldso {

struct CumulativePlotOptions {
  bool log_axis = false;  ///< Else linear from zero up to what nine of ten runs of the best variant stay below.
};

/// The picture as SVG: a curve a variant over all its sequences, directions and repetitions; where loop closing moved a
/// trajectory, a dashed one before it.
std::string cumulative_plot(const DatasetResults& dataset, const ErrorKind& kind,
                            const CumulativePlotOptions& options = {});

/// Where the linear axis ends: 1, 2, 3, 5 or 7.5 times a power of ten, at or above `value` > 0.
double round_axis_end(double value);

}  // namespace ldso
