#include "io/datasets/time_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "util/format_text.h"

namespace ldso {
namespace {

/// Gap between images of the slowest camera that is thought of [s]; the fastest has a thousandth of it.
constexpr double kLongestGap = 5;

struct TimeUnit {
  const char* name;
  double seconds;
};
constexpr std::array<TimeUnit, 4> kUnits{{
    {"seconds", 1},
    {"milliseconds", 1e-3},
    {"microseconds", 1e-6},
    {"nanoseconds", 1e-9},
}};

constexpr std::size_t kFewestFrameNumbers = 3;

double median_gap(const std::vector<double>& times) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < times.size(); ++i) gaps.push_back(std::abs(times[i] - times[i - 1]));
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

const TimeUnit& unit_of(const std::vector<double>& times) {
  const double gap = median_gap(times);
  for (const TimeUnit& unit : kUnits) {
    if (gap * unit.seconds < kLongestGap) return unit;
  }
  return kUnits.front();  // No camera's times: as they are.
}

}  // namespace

double seconds_per_unit(const std::vector<double>& times) { return unit_of(times).seconds; }

bool look_like_frame_numbers(const std::vector<double>& times) {
  if (times.size() < kFewestFrameNumbers) return false;
  const bool whole = std::all_of(times.begin(), times.end(), [](double t) { return t == std::floor(t); });
  return whole && median_gap(times) == 1;
}

void convert_to_seconds(std::vector<double>& times, const std::filesystem::path& path,
                        std::vector<std::string>& warnings) {
  if (look_like_frame_numbers(times)) {
    warnings.push_back(path.string() +
                       ": the times are whole numbers with steps of 1: they are taken for seconds, but look like frame "
                       "numbers");
    return;
  }
  const TimeUnit& unit = unit_of(times);
  if (unit.seconds == 1) return;
  warnings.push_back(path.string() + ": the times are taken for " + unit.name + ", since they are " +
                     format_text("%g", median_gap(times)) + " apart; they are converted to seconds");
  for (double& time : times) time *= unit.seconds;
}

}  // namespace ldso
