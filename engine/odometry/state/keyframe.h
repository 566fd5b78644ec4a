#pragma once

// A keyframe of the sliding window: its image, its state with the point of linearization, its points.

#include <cstdint>
#include <memory>
#include <vector>

#include "image/frame.h"
#include "ldso/records.h"
#include "ldso/se3.h"
#include "odometry/state/brightness.h"
#include "odometry/state/point.h"

namespace ldso {

/// Degrees of freedom of a keyframe in the window: pose (translation, rotation), brightness a, b.
inline constexpr int kFrameDof = 8;
/// Intrinsics fx, fy, cx, cy.
inline constexpr int kCameraDof = 4;

using FrameVector = Eigen::Matrix<double, kFrameDof, 1>;

/// Pose and brightness relative to a fixed point of linearization: first-estimate Jacobians are taken at
/// `T_c_w_lin`, `brightness_lin`; the estimate is exp(delta.pose) * T_c_w_lin, brightness_lin + delta.brightness.
struct FrameState {
  SE3d T_c_w_lin;
  Brightness brightness_lin;
  FrameVector delta = FrameVector::Zero();

  SE3d T_c_w() const { return SE3d::exp(delta.head<6>()) * T_c_w_lin; }
  Brightness brightness() const { return {brightness_lin.a + delta[6], brightness_lin.b + delta[7]}; }
};

struct Keyframe {
  std::shared_ptr<const PreparedFrame> frame;
  int index = 0;  ///< Position in the window, oldest first.
  FrameState state;
  SE3d::Tangent velocity = SE3d::Tangent::Zero();  ///< Of T_c_w, on its left, as tracking saw it [map units/s, rad/s].
  FrameVector delta_backup = FrameVector::Zero();
  FrameVector prior = FrameVector::Zero();            ///< Precision of a diagonal prior around `prior_mean`.
  FrameVector prior_mean = FrameVector::Zero();       ///< In the coordinates of `state.delta`.
  float outlier_energy = 8.0f * 8.0f * kPatternSize;  ///< Energy beyond which a residual is an outlier.
  bool in_prior = false;  ///< Marginalized residuals touch it: its point of linearization is fixed.
  bool leaving = false;   ///< To be marginalized at the end of this keyframe's turn.
  std::vector<ImmaturePoint> immature;
  std::vector<ActivePoint> points;
  std::vector<MapPoint> finished;        ///< Points that were marginalized: they belong to the map.
  std::vector<Eigen::Vector2f> corners;  ///< Pixels of the selected corners, whatever became of them.
  int dropped = 0;                       ///< Points that were given up.

  /// Moves the point of linearization to the estimate; only while no prior touches the frame.
  void relinearize() {
    const SE3d T_c_w = state.T_c_w();
    const Brightness brightness = state.brightness();
    prior_mean -= state.delta;  // Exact for the brightness; poses have a prior only where delta stays 0.
    state = {T_c_w, brightness, FrameVector::Zero()};
  }

  std::int64_t id() const { return frame->id; }
  const Image<Texel>& image() const { return frame->pyramid.levels.front(); }
};

}  // namespace ldso
