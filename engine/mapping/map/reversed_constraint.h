#pragma once

// A constraint between two keyframes as the other one has it.

#include <cstdint>

#include "ldso/records.h"

namespace ldso {

/// `constraint` of keyframe `keyframe_id` seen from its other keyframe: exp(x) T inverted is exp(-Ad(T^-1) x) T^-1.
inline KeyframeConstraint reversed(std::int64_t keyframe_id, const KeyframeConstraint& constraint) {
  const SE3d T_other_this = constraint.T_this_other.inverse();
  const Sim3d::Jacobian A = Sim3d(T_other_this).adjoint();
  return {keyframe_id, T_other_this, A * constraint.covariance * A.transpose()};
}

}  // namespace ldso
