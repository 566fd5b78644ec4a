#pragma once

// How fast the camera was at a frame, from the steps to it and on from it.

#include <array>
#include <optional>

#include "ldso/se3.h"

namespace ldso {

/// The mean velocities of the last steps from frame to frame.
class StepVelocities {
 public:
  static constexpr int kSteps = 4;

  /// A step of `seconds`; those that another frame rate had are forgotten.
  void add(const SE3d::Tangent& velocity, double seconds);
  void clear() { count_ = 0; }

  /// At the frame `steps` (0, 1 or 2) before the last one, as far as the steps around it tell; nothing if too few are
  /// known. At the last one by the parabola through three frames; before it by as many steps after it as before it: one
  /// of each takes off 6 % of a hand's tremor of 3 Hz at 30 frames/s and 17 % of one of 5 Hz, two of each 0.5 and 4 %.
  std::optional<SE3d::Tangent> before_last(int steps) const;

 private:
  std::array<SE3d::Tangent, kSteps> steps_;  ///< The newest first.
  int count_ = 0;
  double seconds_ = 0;
};

}  // namespace ldso
