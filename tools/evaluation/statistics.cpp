#include "evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ldso/error.h"
#include "util/median.h"

namespace ldso {

Statistics summarize(std::vector<double> values) {
  if (values.empty()) throw Error("statistics", "there are no errors to sum up", "");
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(values.begin(), values.end(), finite)) {
    throw Error("statistics", "an error is not finite", "check both trajectories for NaN or infinite poses");
  }
  Statistics result;
  result.count = values.size();
  const double n = static_cast<double>(values.size());
  double sum = 0, sum_of_squares = 0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  result.mean = sum / n;
  result.rmse = std::sqrt(sum_of_squares / n);
  double squared_deviations = 0;
  for (const double value : values) squared_deviations += (value - result.mean) * (value - result.mean);
  result.stddev = std::sqrt(squared_deviations / n);
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  result.min = *min;
  result.max = *max;
  result.median = median_of(std::move(values));
  return result;
}

}  // namespace ldso
