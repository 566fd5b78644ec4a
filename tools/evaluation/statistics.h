#pragma once
// The six figures that sum up a list of errors.

#include <cstddef>
#include <vector>

namespace ldso {

/// All in the unit of the values. `stddev` is that of the population (divided by n).
struct Statistics {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double median = 0;  ///< Of an even number of values: the mean of the two in the middle.
  double stddev = 0;
  double min = 0;
  double max = 0;
};

/// Throws ldso::Error if `values` is empty or holds a value that is not finite.
Statistics summarize(std::vector<double> values);

}  // namespace ldso
