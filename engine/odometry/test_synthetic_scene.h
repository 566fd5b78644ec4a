#pragma once

// A small world with exact truth for the tests and benchmarks of this room: the inside of a convex corner made of
// slanted planes (nothing occludes anything) with a smooth solid texture, and sliding windows of keyframes in it.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "geometry/rolling_shutter.h"
#include "image/frame.h"
#include "image/pyramid.h"
#include "ldso/se3.h"
#include "odometry/depth/epipolar_tracer.h"
#include "odometry/state/window.h"

namespace ldso::test {

inline double uniform(std::mt19937& generator, double low, double high) {
  return low + (high - low) * (static_cast<double>(generator()) / 4294967296.0);
}

inline float random_float(std::mt19937& generator, double low, double high) {
  return static_cast<float>(uniform(generator, low, high));
}

inline SE3d::Tangent random_tangent(std::mt19937& generator, double translation, double rotation) {
  SE3d::Tangent x;
  for (int i = 0; i < 3; ++i) x[i] = uniform(generator, -translation, translation);
  for (int i = 3; i < 6; ++i) x[i] = uniform(generator, -rotation, rotation);
  return x;
}

class SyntheticScene {
 public:
  /// The points with normal . p = distance; the camera is on the side where normal . p is smaller.
  struct Plane {
    Eigen::Vector3d normal;
    double distance;
  };

  static PinholeIntrinsics small_camera() { return {320, 240, 220.0, 222.0, 159.3, 119.8}; }

  static std::vector<Plane> corner() {
    return {{{0.15, -0.10, 1.0}, 2.6}, {{-0.70, 0.10, 0.70}, 2.2}, {{0.0, 0.80, 0.60}, 2.1}};
  }

  explicit SyntheticScene(const PinholeIntrinsics& camera = small_camera(), std::vector<Plane> planes = corner(),
                          unsigned seed = 1)
      : camera_(camera), planes_(std::move(planes)) {
    std::mt19937 generator(seed);
    for (int i = 0; i < 10; ++i) {
      Eigen::Vector3d direction;
      for (int k = 0; k < 3; ++k) direction[k] = uniform(generator, -1, 1);
      // 16 to 55 pixels of the small camera: smooth enough for differences of pixels to be derivatives.
      const double frequency = uniform(generator, 10, 35);
      waves_.push_back(
          {frequency * direction.normalized(), uniform(generator, 0, 2 * M_PI), uniform(generator, 8, 12)});
    }
  }

  const PinholeIntrinsics& camera() const { return camera_; }

  /// From now on rays (x, y, 1) are seen at (1 + k (x^2 + y^2)) (x, y).
  void set_radial(double k) { radial_ = k; }

  double idepth(const SE3d& T_c_w, double u, double v) const { return idepth_along(T_c_w.inverse(), ray(u, v)); }

  double grey(const SE3d& T_c_w, double u, double v) const { return grey_along(T_c_w.inverse(), ray(u, v)); }

  /// `readout`: of a rolling shutter.
  std::shared_ptr<const PreparedFrame> render(std::int64_t id, const SE3d& T_c_w, double gain = 1, double offset = 0,
                                              const ReadoutMotion& readout = ReadoutMotion::Zero()) const {
    Image<float> image(camera_.width, camera_.height);
    for (int y = 0; y < camera_.height; ++y) {
      const SE3d T_w_c = row_pose(T_c_w, readout, y).inverse();
      for (int x = 0; x < camera_.width; ++x) {
        image(x, y) = static_cast<float>(std::max(0.0, gain * grey_along(T_w_c, ray(x, y)) + offset));
      }
    }
    auto frame = std::make_shared<PreparedFrame>();
    frame->id = id;
    frame->timestamp = 0.1 * static_cast<double>(id);
    frame->pyramid = build_pyramid(image.view());
    return frame;
  }

  /// Where the camera is while row y is read.
  SE3d row_pose(const SE3d& T_c_w, const ReadoutMotion& readout, double y) const {
    return readout.isZero(0) ? T_c_w : SE3d::exp(row_time(y, camera_.height) * readout) * T_c_w;
  }

 private:
  struct Wave {
    Eigen::Vector3d k;
    double phase, amplitude;
  };

  Eigen::Vector3d ray(double u, double v) const {
    const Eigen::Vector2d seen((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy);
    Eigen::Vector2d ray = seen;
    for (int i = 0; i < 10 && radial_ != 0; ++i) ray = seen / (1 + radial_ * ray.squaredNorm());
    return ray.homogeneous();
  }

  double idepth_along(const SE3d& T_w_c, const Eigen::Vector3d& ray_c) const {
    const Eigen::Vector3d direction = T_w_c.rotation() * ray_c;
    double nearest = 0;
    for (const Plane& plane : planes_) {
      nearest =
          std::max(nearest, plane.normal.dot(direction) / (plane.distance - plane.normal.dot(T_w_c.translation())));
    }
    return nearest;
  }

  double grey_along(const SE3d& T_w_c, const Eigen::Vector3d& ray_c) const {
    const Eigen::Vector3d p = T_w_c * Eigen::Vector3d(ray_c / std::max(1e-3, idepth_along(T_w_c, ray_c)));
    double grey = 128;
    for (const Wave& wave : waves_) grey += wave.amplitude * std::sin(wave.k.dot(p) + wave.phase);
    return grey;
  }

  PinholeIntrinsics camera_;
  double radial_ = 0;
  std::vector<Plane> planes_;
  std::vector<Wave> waves_;
};

/// T_c_w of the i-th view of a camera that moves sideways, a bit up and forward, and turns slowly.
inline SE3d path_pose(double i) {
  SE3d::Tangent x;
  x << -0.07 * i, 0.02 * std::sin(i), -0.03 * i, 0.006 * i, -0.010 * i, 0.01 * std::sin(0.7 * i);
  return SE3d::exp(x);
}

inline Window empty_window(const PinholeIntrinsics& camera) {
  Window window;
  window.width = camera.width;
  window.height = camera.height;
  window.camera << camera.fx, camera.fy, camera.cx, camera.cy;
  window.camera_lin = window.camera;
  window.prior.reset(kCameraDof);
  return window;
}

/// Appends a keyframe; existing points get a residual into it.
inline Keyframe& add_keyframe(Window& window, std::shared_ptr<const PreparedFrame> frame, const SE3d& T_c_w,
                              const Brightness& brightness = {}) {
  return window.append(std::move(frame), T_c_w, brightness);
}

/// Adds points of true inverse depth on a grid, with residuals into all other keyframes.
inline void add_points(Window& window, Keyframe& host, const SyntheticScene& scene, const SE3d& T_c_w_true, int spacing,
                       int margin = 8) {
  for (int v = margin; v < window.height - margin; v += spacing) {
    const SE3d T_row_w = scene.row_pose(T_c_w_true, window.readout(host), v);
    for (int u = margin; u < window.width - margin; u += spacing) {
      ImmaturePoint immature;
      if (!make_immature_point(host.image(), static_cast<float>(u), static_cast<float>(v), immature)) continue;
      ActivePoint point;
      point.u = immature.u;
      point.v = immature.v;
      point.idepth = static_cast<float>(scene.idepth(T_row_w, u, v));
      point.idepth_hessian = 1000;
      point.patch = immature.patch;
      for (auto& target : window.keyframes) {
        if (target.get() == &host) continue;
        PointResidual residual;
        residual.target = target.get();
        point.residuals.push_back(residual);
      }
      host.points.push_back(std::move(point));
    }
  }
}

/// Frames 0..count-1 of the path.
inline std::vector<std::shared_ptr<const PreparedFrame>> render_path(const SyntheticScene& scene, int count) {
  std::vector<std::shared_ptr<const PreparedFrame>> frames;
  for (int i = 0; i < count; ++i) frames.push_back(scene.render(i, path_pose(i)));
  return frames;
}

/// A window at the truth: all frames are keyframes with points.
inline Window true_window(const SyntheticScene& scene, const std::vector<std::shared_ptr<const PreparedFrame>>& frames,
                          int spacing) {
  Window window = empty_window(scene.camera());
  for (const auto& frame : frames) add_keyframe(window, frame, path_pose(static_cast<double>(frame->id)));
  for (auto& keyframe : window.keyframes) {
    add_points(window, *keyframe, scene, path_pose(static_cast<double>(keyframe->id())), spacing);
  }
  return window;
}

/// Velocity along the path, ten views a second.
inline SE3d::Tangent path_velocity(double i) {
  constexpr double kStep = 1e-4, kViewsPerSecond = 10;
  return (path_pose(i + kStep) * path_pose(i - kStep).inverse()).log() / (2 * kStep) * kViewsPerSecond;
}

/// The same seen through a rolling shutter; keyframes know their velocity.
inline Window rolling_window(const SyntheticScene& scene, int count, double readout_s, int spacing) {
  Window window = empty_window(scene.camera());
  window.readout_s = readout_s;
  for (int i = 0; i < count; ++i) {
    const SE3d::Tangent velocity = path_velocity(i);
    add_keyframe(window, scene.render(i, path_pose(i), 1, 0, readout_s * velocity), path_pose(i)).velocity = velocity;
  }
  for (auto& keyframe : window.keyframes) {
    add_points(window, *keyframe, scene, path_pose(static_cast<double>(keyframe->id())), spacing);
  }
  return window;
}

/// Moves poses (translation, rotation [rad]), brightness and inverse depths (relative) away; the first keyframe stays.
/// The moved state is the point of linearization.
inline void disturb(Window& window, double translation, double rotation, double brightness_a, double brightness_b,
                    double idepth, unsigned seed) {
  std::mt19937 generator(seed);
  for (auto& keyframe : window.keyframes) {
    for (ActivePoint& point : keyframe->points) {
      point.idepth *= static_cast<float>(1 + uniform(generator, -idepth, idepth));
    }
    if (keyframe->index == 0) continue;
    const SE3d T_c_w = SE3d::exp(random_tangent(generator, translation, rotation)) * keyframe->state.T_c_w();
    const Brightness before = keyframe->state.brightness();
    const Brightness moved{before.a + uniform(generator, -brightness_a, brightness_a),
                           before.b + uniform(generator, -brightness_b, brightness_b)};
    keyframe->state = {T_c_w, moved, FrameVector::Zero()};
  }
}

}  // namespace ldso::test
