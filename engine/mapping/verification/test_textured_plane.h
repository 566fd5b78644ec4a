#pragma once

// A tilted plane with a smooth random texture, and its exact images: what grey levels say of where cameras are.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "geometry/pinhole_projection.h"
#include "image/pyramid.h"
#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/se3.h"

namespace ldso::loop_test {

/// Waves of random direction, length and phase; grey levels 40..215.
class Texture {
 public:
  explicit Texture(std::uint64_t seed, double shortest, double longest) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 24; ++i) {
      const double length = shortest * std::pow(longest / shortest, share(random)), turn = 2 * M_PI * share(random);
      waves_.emplace_back(2 * M_PI / length * std::cos(turn), 2 * M_PI / length * std::sin(turn),
                          2 * M_PI * share(random));
    }
  }
  double operator()(double x, double y) const {
    double sum = 0;
    for (const Eigen::Vector3d& w : waves_) sum += std::sin(w.x() * x + w.y() * y + w.z());
    return 127.5 + 87.5 * std::tanh(sum / std::sqrt(static_cast<double>(waves_.size())));
  }

 private:
  std::vector<Eigen::Vector3d> waves_;
};

inline Image<Texel> texels(const Image<float>& image) { return std::move(build_pyramid(image.view()).levels.front()); }

/// z = 5 + x / 5 in the world's frame [m].
struct TexturedPlane {
  Texture texture{3, 0.12, 0.8};

  /// Depth [m] of what the camera sees at `pixel`, and where on the plane that is.
  double depth(const PinholeIntrinsics& camera, const SE3d& T_world_camera, const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d direction = T_world_camera.rotation() * viewing_ray(camera, pixel);
    const Eigen::Vector3d& origin = T_world_camera.translation();
    return (5 + origin.x() / 5 - origin.z()) / (direction.z() - direction.x() / 5);
  }

  Image<Texel> render(const PinholeIntrinsics& camera, const SE3d& T_world_camera, double noise = 0,
                      std::uint64_t seed = 1) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, 1);
    Image<float> image(camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector2d pixel(u, v);
        const Eigen::Vector3d p =
            T_world_camera * (depth(camera, T_world_camera, pixel) * viewing_ray(camera, pixel)).eval();
        image(u, v) = static_cast<float>(texture(p.x(), p.y()) + noise * normal(random));
      }
    }
    return texels(image);
  }
};

}  // namespace ldso::loop_test
