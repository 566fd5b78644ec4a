#include "odometry/window/finished_keyframe.h"

#include <algorithm>
#include <cmath>

#include "odometry/window/relative_pose_covariance.h"

namespace ldso {
namespace {

/// Of an inverse depth: below it, or if it is no number, nothing is known.
constexpr float kLeastKnownHessian = 1e-3f;

FinishedKeyframe finish(const Window& window, const Keyframe& keyframe, bool with_active) {
  FinishedKeyframe finished;
  finished.frame = keyframe.frame;
  finished.corners = keyframe.corners;
  KeyframeUpdate& update = finished.update;
  update.frame_id = keyframe.id();
  update.timestamp = keyframe.frame->timestamp;
  update.camera = window.intrinsics();
  update.T_world_camera = keyframe.state.T_c_w().inverse();
  update.readout = window.readout(keyframe);
  update.points = keyframe.finished;
  if (!with_active) return finished;
  for (const ActivePoint& point : keyframe.points) {
    if (point.good_residuals >= kLeastGoodResiduals)
      update.points.push_back(make_map_point(point, window.residual_variance()));
  }
  return finished;
}

/// `gone`: keyframes of the window that have had their constraints to this one.
void add_constraints(const Window& window, int i, const std::vector<bool>& gone,
                     const RelativePoseCovariance& covariance, KeyframeUpdate& update) {
  const SE3d& T_i_w = window.keyframes[i]->state.T_c_w();
  for (int j = 0; j < window.size(); ++j) {
    if (j == i || gone[j]) continue;
    const Keyframe& other = *window.keyframes[j];
    update.constraints.push_back({other.id(), T_i_w * other.state.T_c_w().inverse(), covariance(i, j)});
  }
}

std::vector<FinishedKeyframe> finish_some(const Window& window, bool all) {
  std::vector<FinishedKeyframe> finished;
  std::vector<bool> gone(window.size(), false);
  const bool any = all || std::any_of(window.keyframes.begin(), window.keyframes.end(),
                                      [](const auto& keyframe) { return keyframe->leaving; });
  if (!any || window.size() == 0) return finished;
  const RelativePoseCovariance covariance(window);
  for (int i = 0; i < window.size(); ++i) {
    if (!all && !window.keyframes[i]->leaving) continue;
    finished.push_back(finish(window, *window.keyframes[i], all));
    gone[i] = true;
    add_constraints(window, i, gone, covariance, finished.back().update);
  }
  return finished;
}

}  // namespace

MapPoint make_map_point(const ActivePoint& point, double residual_variance) {
  MapPoint result;
  result.u = point.u;
  result.v = point.v;
  result.idepth = point.idepth;
  const float hessian = point.idepth_hessian > kLeastKnownHessian ? point.idepth_hessian : kLeastKnownHessian;
  result.idepth_stddev = static_cast<float>(std::sqrt(residual_variance)) * std::sqrt(1.0f / hessian);
  result.intensity = point.patch.intensity[4];
  result.is_corner = point.is_corner;
  return result;
}

std::vector<FinishedKeyframe> finish_leaving(const Window& window) { return finish_some(window, false); }

std::vector<FinishedKeyframe> finish_all(const Window& window) { return finish_some(window, true); }

}  // namespace ldso
