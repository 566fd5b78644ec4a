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

}  // namespace ldso
