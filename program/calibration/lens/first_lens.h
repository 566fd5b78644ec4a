#pragma once
// A lens to begin the adjustment with, from nothing but the views.

#include <optional>
#include <vector>

#include "calibration/lens/lens_adjustment.h"

namespace ldso {

/// Pose of a board by the homography of its points to their rays; nothing if fewer than four have one or they lie in a
/// line.
std::optional<SE3d> board_pose(const ObservedView& view, const CameraModel& camera);

/// Several fields of view are tried on some of the views, and the one that explains them best is taken, without poses.
/// Nothing if none explains them: too few points, or no board.
std::optional<LensAndPoses> first_lens(const std::vector<ObservedView>& views, LensKind kind, int width, int height);

}  // namespace ldso
