#pragma once

// A loop made up: points in a candidate's camera with uncertain depth, seen by a current keyframe whose similarity to
// the candidate is known, part of them with a depth there too. All errors are drawn from the noise that is claimed.

#include <random>
#include <vector>

#include "geometry/pinhole_projection.h"
#include "mapping/verification/sim3_residual.h"

namespace ldso {

struct Sim3Scene {
  PinholeIntrinsics camera{640, 480, 500, 510, 320.5, 239.5};
  Sim3d truth{SO3d::exp(Eigen::Vector3d(0.05, -0.3, 0.1)), Eigen::Vector3d(0.8, -0.2, 0.5), 1.3};
  std::vector<Sim3Correspondence> matches;
  std::vector<bool> is_true, is_true_depth;
};

struct Sim3SceneSettings {
  int count = 150;
  double depth_share = 0.6;        ///< With depth in the current keyframe.
  double outlier_share = 0;        ///< Pixel and depth have nothing to do with the point.
  double depth_outlier_share = 0;  ///< Only the current depth is wrong.
  double candidate_pixel_sigma = 0.5;
  double pixel_sigma = 1;              ///< Claimed.
  double relative_depth_sigma = 0.05;  ///< Claimed, of both sides; between half and twice that.
  double noise_scale = 1;              ///< True noise over claimed noise.
  double idepth_noise_scale = 1;       ///< On top, for the current depths.
};

inline Sim3Scene make_sim3_scene(unsigned seed, const Sim3SceneSettings& settings = {}) {
  Sim3Scene scene;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> u(0, 639), v(0, 479), depth(2, 12), share(0, 1), spread(0.5, 2);
  std::normal_distribution<double> normal(0, 1);
  const auto noise = [&](double sigma) { return settings.noise_scale * sigma * normal(generator); };
  const auto pixel_noise = [&](double sigma) {
    const double x = noise(sigma);
    return Eigen::Vector2d(x, noise(sigma));
  };
  while (static_cast<int>(scene.matches.size()) < settings.count) {
    // The true point, as the candidate sees it, then disturbed.
    const Eigen::Vector2d candidate_pixel(u(generator), v(generator));
    const double idepth = 1 / depth(generator);
    const Eigen::Vector3d p = scene.truth * (viewing_ray(scene.camera, candidate_pixel) / idepth);
    const Eigen::Vector2d pixel = project(scene.camera, p);
    if (p.z() < 0.5 || (pixel.array() < 0).any() || pixel.x() > 639 || pixel.y() > 479) continue;
    const double idepth_sigma = settings.relative_depth_sigma * spread(generator) * idepth;
    Sim3Correspondence c;
    c.point = back_project(scene.camera, candidate_pixel + pixel_noise(settings.candidate_pixel_sigma),
                           settings.candidate_pixel_sigma, idepth + noise(idepth_sigma), idepth_sigma);
    c.sigma_px = settings.pixel_sigma;
    c.pixel = pixel + pixel_noise(c.sigma_px);
    const double sigma = settings.relative_depth_sigma * spread(generator) / p.z();
    if (share(generator) < settings.depth_share) {
      c.idepth = 1 / p.z() + settings.idepth_noise_scale * noise(sigma);
      c.idepth_stddev = sigma;
    }
    const bool is_true = share(generator) >= settings.outlier_share;
    if (!is_true) c.pixel = Eigen::Vector2d(u(generator), v(generator));
    const bool is_true_depth = is_true && share(generator) >= settings.depth_outlier_share;
    if (!is_true_depth && c.idepth > 0) c.idepth = 1 / depth(generator);
    scene.matches.push_back(c);
    scene.is_true.push_back(is_true);
    scene.is_true_depth.push_back(is_true_depth && c.idepth > 0);
  }
  return scene;
}

}  // namespace ldso
