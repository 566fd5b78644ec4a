#pragma once
// Colour-coded errors of all runs: each run a square, a column a sequence, rows grouped by variant and direction (as
// the paper's Figs. 4 and 6).

#include <string>

#include "experiment/results/run_groups.h"

namespace ldso {

/// The picture as SVG. A failed run is a white square with a red cross, a pending one is empty, one that could not be
/// measured has a question mark. The title names job and error, which browsers show under the pointer.
std::string block_plot(const DatasetResults& dataset, const ErrorKind& kind);

}  // namespace ldso
