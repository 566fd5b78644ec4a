#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ldso {

/// The middle one of the values in their order, the upper of both if their number is even. There is at least one;
/// they are reordered.
template <class T>
T upper_median(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The middle one of the values in their order, the mean of both if their number is even. There is at least one; they
/// may be infinite.
inline double median_of(std::vector<double> values) {
  const double upper = upper_median(values);
  if (values.size() % 2 == 1) return upper;
  const double lower =
      *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return lower == upper ? lower : 0.5 * (lower + upper);
}

}  // namespace ldso
