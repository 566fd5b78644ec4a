#pragma once

// The directions that images cannot determine: global pose and scale. First-estimate Jacobians keep them free in the
// normal equations (DSO section 2.3). The pose is held by the prior of the map's first keyframe, and by what that one
// leaves behind; nothing holds the scale.

#include "odometry/state/window.h"

namespace ldso {

/// Orthonormal basis (columns) of the gauge at the points of linearization, `window.dim()` rows; 7 columns if the
/// camera has moved.
Eigen::MatrixXd gauge_basis(const Window& window);

/// Takes the change of scale, about the centre of the map's first keyframe, out of a step of all variables: it is
/// noise. The global pose stays in the step, other than in (DSO section 2.3): where the prior holds a keyframe, a step
/// that is made to keep the mean pose moves that keyframe. The stiff prior's energy then rises by more than all
/// residuals fall, the step is refused, and a window that started badly never gets to its minimum.
void remove_scale(const Window& window, Eigen::VectorXd& step);

/// Takes the gauge out of information that residuals give. They hold none, but sums of single-precision numbers do: a
/// little of it, of either sign. Where it is negative the prior pushes the window away from where it is, the more the
/// farther the window has come since, without bound.
void remove_gauge(const Window& window, Eigen::MatrixXd& H, Eigen::VectorXd& b);

}  // namespace ldso
