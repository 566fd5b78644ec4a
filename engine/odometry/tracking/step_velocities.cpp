#include "odometry/tracking/step_velocities.h"

#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

/// Steps whose times differ by a larger share are not taken together: a frame is missing between them.
constexpr double kLargestUnevenness = 0.2;

}  // namespace

void StepVelocities::add(const SE3d::Tangent& velocity, double seconds) {
  const bool is_even = std::abs(seconds - seconds_) <= kLargestUnevenness * std::abs(seconds_);
  if (!is_even) clear();
  std::shift_right(steps_.begin(), steps_.end(), 1);
  steps_.front() = velocity;
  count_ = std::min(count_ + 1, kSteps);
  seconds_ = seconds;
}

std::optional<SE3d::Tangent> StepVelocities::before_last(int steps) const {
  if (count_ < std::max(2, 2 * steps)) return std::nullopt;
  if (steps == 0) return 1.5 * steps_[0] - 0.5 * steps_[1];
  if (steps == 1) return 0.5 * (steps_[0] + steps_[1]);
  // The derivative of the polynomial of fourth degree through five places, by their differences.
  return (7.0 * (steps_[1] + steps_[2]) - (steps_[0] + steps_[3])) / 12.0;
}

}  // namespace ldso
