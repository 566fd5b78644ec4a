#include "mapping/verification/loop_sharpener.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "geometry/pinhole_projection.h"
#include "geometry/rolling_shutter.h"
#include "mapping/map/local_map.h"

namespace ldso {
namespace {

/// Matched corners with depth, by the point of the local map they are of.
using MatchOfPoint = std::map<std::pair<int, int>, const LoopMatch*>;

MatchOfPoint matches_with_depth(const LoopVerification& loop) {
  MatchOfPoint matches;
  for (const LoopMatch& match : loop.matches) {
    if (match.inlier && match.idepth > 0) matches[{match.keyframe, match.feature}] = &match;
  }
  return matches;
}

/// Where the current camera sees the host's pixel, given its inverse depth.
std::optional<PixelDepth> transfer(const PinholeIntrinsics& camera, const Sim3d& S_current_host,
                                   const Eigen::Vector2d& pixel, double idepth) {
  const Eigen::Vector3d p = S_current_host * (viewing_ray(camera, pixel) / idepth).eval();
  if (!(p.z() > 0)) return std::nullopt;
  return PixelDepth{project(camera, p), 1 / p.z()};
}

/// How offsets around the host's pixel are seen in the current image, if the surface there faces the host.
std::optional<Eigen::Matrix2d> warp_of(const PinholeIntrinsics& camera, const Sim3d& S_current_host,
                                       const Eigen::Vector2d& pixel, double idepth) {
  Eigen::Matrix2d warp;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d::Unit(k);
    const auto ahead = transfer(camera, S_current_host, pixel + half, idepth);
    const auto behind = transfer(camera, S_current_host, pixel - half, idepth);
    if (!ahead || !behind) return std::nullopt;
    warp.col(k) = ahead->pixel - behind->pixel;
  }
  return warp;
}

bool is_comparable(const Eigen::Matrix2d& warp, double max_magnification) {
  const double area = warp.determinant(), limit = max_magnification * max_magnification;
  return area < limit && area > 1 / limit;
}

/// Nothing if its patch is not found well enough in the image.
std::optional<Sim3Correspondence> find_point(const LocalPoint& point, const MapFeature& feature,
                                             const PinholeIntrinsics& camera, const CurrentImage& current,
                                             const Sim3d& S, const LoopSharpeningSettings& settings) {
  const Sim3d S_current_host = S * Sim3d(point.T_local_host);
  const Eigen::Vector2d pixel(feature.feature.u, feature.feature.v);
  const auto start = transfer(camera, S_current_host, pixel, feature.idepth);
  const auto warp = warp_of(camera, S_current_host, pixel, feature.idepth);
  if (!start || !warp || !is_comparable(*warp, settings.max_magnification)) return std::nullopt;
  const Eigen::Vector2d seen = with_readout(camera, current.readout, start->pixel, start->idepth);
  const auto found = align_patch(feature.patch, current.image, seen, *warp, settings.alignment);
  if (!found) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(found->covariance, Eigen::EigenvaluesOnly);
  Sim3Correspondence c;
  c.point = point.point;
  c.pixel = without_readout(camera, current.readout, found->pixel, start->idepth).pixel;
  c.sigma_px = std::max(settings.least_stddev, std::sqrt(std::max(eigen.eigenvalues()[1], 0.0)));
  if (!(c.sigma_px <= settings.max_stddev)) return std::nullopt;
  return c;
}

/// The current depth from the corner that was matched with the same point, if it lies near enough.
void lend_depth(const LoopMatch& match, double max_shift_px, Sim3Correspondence& c) {
  if ((match.pixel.cast<double>() - c.pixel).norm() > max_shift_px) return;
  c.idepth = match.idepth;
  c.idepth_stddev = match.idepth_stddev;
}

/// Points that were found: what the estimate takes, and which they are.
struct FoundPoints {
  std::vector<Sim3Correspondence> correspondences;
  std::vector<LoopPatch> patches;
};

FoundPoints find_points(const KeyframeMap& map, int candidate, const PinholeIntrinsics& camera,
                        const CurrentImage& current, const LoopVerification& loop,
                        const LoopSharpeningSettings& settings) {
  const MatchOfPoint matches = matches_with_depth(loop);
  const auto cell = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Array2d place = pixel.array() / Eigen::Array2d(camera.width, camera.height);
    const Eigen::Array2i c = (place * settings.cells).cast<int>().max(0).min(settings.cells - 1);
    return c.y() * settings.cells + c.x();
  };
  FoundPoints found;
  for (const LocalPoint& point : local_map(map, camera, candidate)) {
    const MapFeature& feature = map[point.keyframe].features[point.feature];
    std::optional<Sim3Correspondence> c =
        find_point(point, feature, camera, current, loop.sim3.S_current_candidate, settings);
    if (!c) continue;
    const auto match = matches.find({point.keyframe, point.feature});
    if (match != matches.end()) lend_depth(*match->second, settings.max_depth_shift, *c);
    c->group = cell(c->pixel);
    found.correspondences.push_back(*c);
    found.patches.push_back({point.keyframe, point.feature, c->pixel});
  }
  return found;
}

}  // namespace

std::optional<SharpLoop> sharpen_loop(const KeyframeMap& map, int candidate, const PinholeIntrinsics& camera,
                                      const CurrentImage& current, const LoopVerification& loop,
                                      const LoopSharpeningSettings& settings) {
  const FoundPoints found = find_points(map, candidate, camera, current, loop, settings);
  SharpLoop sharp;
  sharp.estimate = estimate_sim3(found.correspondences, camera, loop.sim3.S_current_candidate, settings.similarity);
  const Sim3Estimate& estimate = sharp.estimate;
  const double enough = std::max<double>(settings.min_inliers, settings.min_inlier_share * found.patches.size());
  const bool stands = estimate.status == Sim3Status::kOk && estimate.scale_determined && estimate.num_inliers >= enough;
  if (!stands) return std::nullopt;
  for (std::size_t i = 0; i < found.patches.size(); ++i) {
    if (estimate.is_inlier[i]) sharp.patches.push_back(found.patches[i]);
  }
  return sharp;
}

}  // namespace ldso
