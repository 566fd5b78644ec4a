#pragma once

// A small world with exact truth for the tests of this room: a slanted wall, a nearer board before part of
// it (a step in depth) and a floor, all with band-limited textures, seen by a pinhole camera.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "image/frame.h"
#include "image/pyramid.h"
#include "ldso/se3.h"

namespace ldso::test {

struct Look {
  double gain = 1;
  double offset = 0;
  double noise = 0;  ///< Standard deviation [grey levels].
};

class Scene {
 public:
  explicit Scene(const PinholeIntrinsics& camera) : camera_(camera) {
    std::mt19937 generator(7);
    for (int i = 0; i < 20; ++i) {
      const double angle = uniform(generator) * M_PI;
      const double frequency = 2.0 * std::pow(8.0, uniform(generator));  // [rad / unit]
      waves_.push_back({frequency * std::cos(angle), frequency * std::sin(angle), uniform(generator) * 2 * M_PI,
                        10.0 + 6.0 * uniform(generator)});
    }
  }

  /// The world's depth [along z] and texture at a pixel; the world's frame is the first camera's.
  struct Hit {
    double depth = 0;
    double grey = 128;
    int plane = -1;
  };
  Hit look(const SE3d& T_world_camera, double u, double v) const {
    const Eigen::Vector3d ray((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1);
    const Eigen::Vector3d d = T_world_camera.rotation() * ray;
    const Eigen::Vector3d& o = T_world_camera.translation();
    Hit best{std::numeric_limits<double>::infinity(), 128, -1};
    try_plane(o, d, Eigen::Vector3d(0.25, 0.05, 1), 5.0, 0, best);  // wall
    try_plane(o, d, Eigen::Vector3d(0, 1, 0), 1.2, 1, best);        // floor
    try_plane(o, d, Eigen::Vector3d(0, 0, 1), 2.5, 2, best);        // board
    if (best.plane >= 0) best.grey = texture(o + best.depth * d, best.plane);
    return best;
  }

  std::shared_ptr<const PreparedFrame> frame(std::int64_t id, const SE3d& T_world_camera, const Look& how = {}) const {
    std::mt19937 generator(static_cast<std::uint32_t>(id + 1));
    Image<Hit> hits(camera_.width, camera_.height);
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) hits(x, y) = look(T_world_camera, x, y);
    }
    Image<float> image(camera_.width, camera_.height);
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        // A sum of uniform numbers: about normal, and the same with every standard library.
        double noise = -1.5;
        for (int k = 0; k < 3; ++k) noise += uniform(generator);
        const double grey = how.gain * pixel(hits, T_world_camera, x, y) + how.offset + 2 * how.noise * noise;
        image(x, y) = static_cast<float>(std::min(250.0, std::max(0.0, grey)));
      }
    }
    auto result = std::make_shared<PreparedFrame>();
    result->id = id;
    result->timestamp = 0.1 * static_cast<double>(id);
    const Image<float>& masked = image;
    result->pyramid = build_pyramid(masked.view());
    return result;
  }

 private:
  struct Wave {
    double fx, fy, phase, amplitude;
  };

  /// Averaged over the pixel where planes meet: steps locked to the pixel grid would not move with the camera.
  double pixel(const Image<Hit>& hits, const SE3d& T_world_camera, int x, int y) const {
    bool edge = false;
    for (int v = std::max(0, y - 1); v <= std::min(camera_.height - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(camera_.width - 1, x + 1); ++u) {
        edge = edge || hits(u, v).plane != hits(x, y).plane;
      }
    }
    if (!edge) return hits(x, y).grey;
    constexpr int kSide = 8;
    double sum = 0;
    for (int k = 0; k < kSide * kSide; ++k) {
      const int row = k / kSide, column = k % kSide;
      sum += look(T_world_camera, x + (column - 3.5) / kSide, y + (row - 3.5) / kSide).grey;
    }
    return sum / (kSide * kSide);
  }

  static double uniform(std::mt19937& generator) { return generator() / 4294967296.0; }

  void try_plane(const Eigen::Vector3d& o, const Eigen::Vector3d& d, const Eigen::Vector3d& normal, double distance,
                 int which, Hit& best) const {
    const double depth = (distance - normal.dot(o)) / normal.dot(d);
    if (!(depth > 0.05) || depth >= best.depth) return;
    const Eigen::Vector3d p = o + depth * d;
    const bool board = which == 2;
    if (board && (std::abs(p.x() - 0.5) > 0.55 || std::abs(p.y() + 0.2) > 0.5)) return;
    best.depth = depth;
    best.plane = which;
  }

  double texture(const Eigen::Vector3d& p, int plane) const {
    double grey = 120;
    // Finer where it is near, coarser where it is seen at a grazing angle: no aliasing.
    const double fineness = plane == 2 ? 1.6 : plane == 1 ? 0.35 : 1.0;
    const double s = fineness * p.x() + 3.7 * plane;
    const double t = fineness * (plane == 1 ? p.z() : p.y()) + 1.9 * plane;
    for (const Wave& w : waves_) grey += w.amplitude * std::sin(w.fx * s + w.fy * t + w.phase);
    return grey;
  }

  PinholeIntrinsics camera_;
  std::vector<Wave> waves_;
};

}  // namespace ldso::test
