#include "odometry/window_start.h"

#include <utility>

#include "odometry/depth/epipolar_tracer.h"

namespace ldso {
namespace {

/// Precision of the prior that holds the first keyframe's place, far above all that residuals tell [1 / map unit^2].
constexpr double kFirstTranslationPrior = 4e10;
/// Precision of the prior that holds the first keyframe's rotation [1 / rad^2].
constexpr double kFirstRotationPrior = 1e11;
/// Precision of the prior that holds the first keyframe's log brightness factor.
constexpr double kFirstBrightnessPriorA = 1e12;
/// Precision of the prior that holds the first keyframe's brightness offset [1 / grey levels^2].
constexpr double kFirstBrightnessPriorB = 1e8;

Window empty_window(const WindowPlace& place, const WindowSettings& settings) {
  Window window;
  window.width = place.camera.width;
  window.height = place.camera.height;
  window.readout_s = place.readout_s;
  window.camera << place.camera.fx, place.camera.fy, place.camera.cx, place.camera.cy;
  window.camera_lin = window.camera;
  window.camera_prior << settings.focal_prior, settings.focal_prior, settings.center_prior, settings.center_prior;
  window.prior.reset(kCameraDof);
  window.held_center = place.T_c_w.inverse().translation();
  return window;
}

void add_points(const Initialization& start, double scale, double idepth_prior, Keyframe& keyframe) {
  for (const InitialPoint& initial : start.points) {
    if (initial.is_corner) keyframe.corners.emplace_back(initial.u, initial.v);
    ImmaturePoint immature;
    if (!initial.is_good || !make_immature_point(keyframe.image(), initial.u, initial.v, immature)) continue;
    ActivePoint point;
    point.u = initial.u;
    point.v = initial.v;
    point.idepth = initial.idepth / static_cast<float>(scale);
    point.idepth_damping = static_cast<float>(idepth_prior * scale * scale);
    point.is_corner = initial.is_corner;
    point.patch = immature.patch;
    keyframe.points.push_back(std::move(point));
  }
}

}  // namespace

SE3d scaled_motion(const Initialization& start, const WindowPlace& place) {
  return SE3d(start.T_current_first.rotation(), start.T_current_first.translation() * place.scale);
}

Window start_window(const Initialization& start, const std::shared_ptr<const PreparedFrame>& first,
                    const WindowPlace& place, const WindowSettings& settings) {
  Window window = empty_window(place, settings);
  Keyframe& keyframe = window.append(first, place.T_c_w, {});
  keyframe.prior << Eigen::Vector3d::Constant(kFirstTranslationPrior), Eigen::Vector3d::Constant(kFirstRotationPrior),
      kFirstBrightnessPriorA, kFirstBrightnessPriorB;
  add_points(start, place.scale, settings.idepth_prior, keyframe);
  return window;
}

}  // namespace ldso
