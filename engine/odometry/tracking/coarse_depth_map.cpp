#include "odometry/tracking/coarse_depth_map.h"

#include <cmath>

#include "odometry/residual/photometric_residual.h"

namespace ldso {
namespace {

/// Weighted inverse depths of one level.
struct DepthGrid {
  Image<float> weighted;  ///< Sum of idepth * weight.
  Image<float> weight;    ///< Sum of weights; 0: no depth.
};

DepthGrid splat(const std::vector<DepthSample>& samples, int width, int height) {
  DepthGrid grid{Image<float>(width, height, 0.0f), Image<float>(width, height, 0.0f)};
  for (const DepthSample& s : samples) {
    // Not lround, a slow call: truncation is wrong for negative numbers only, in columns and rows collect() leaves out.
    const float u = s.u + 0.5f, v = s.v + 0.5f;
    if (!(u > -1 && v > -1 && u < static_cast<float>(width) && v < static_cast<float>(height))) continue;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    grid.weighted(x, y) += s.idepth * s.weight;
    grid.weight(x, y) += s.weight;
  }
  return grid;
}

DepthGrid halve(const DepthGrid& fine, int width, int height) {
  DepthGrid grid{Image<float>(width, height, 0.0f), Image<float>(width, height, 0.0f)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        grid.weighted(x, y) += fine.weighted(2 * x + dx, 2 * y + dy);
        grid.weight(x, y) += fine.weight(2 * x + dx, 2 * y + dy);
      }
    }
  }
  return grid;
}

/// Gives pixels without depth the mean of their four neighbours with depth: diagonal ones on the fine levels, where
/// points lie sparse, direct ones on the coarse.
void dilate(DepthGrid& grid, bool diagonal) {
  const DepthGrid before = grid;
  const int width = grid.weight.width(), height = grid.weight.height();
  const int step = diagonal ? width + 1 : 1;
  const int other_step = diagonal ? width - 1 : width;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      if (before.weight(x, y) > 0) continue;
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * width + x;
      float weighted = 0, weight = 0;
      int neighbours = 0;
      for (const std::ptrdiff_t n : {at + step, at - step, at + other_step, at - other_step}) {
        if (!(before.weight.data()[n] > 0)) continue;
        weighted += before.weighted.data()[n];
        weight += before.weight.data()[n];
        ++neighbours;
      }
      if (neighbours == 0) continue;
      grid.weighted(x, y) = weighted / static_cast<float>(neighbours);
      grid.weight(x, y) = weight / static_cast<float>(neighbours);
    }
  }
}

AlignmentPoints collect(const DepthGrid& grid, const Image<Texel>& image) {
  AlignmentPoints points;
  for (int y = 2; y + 2 < image.height(); ++y) {
    for (int x = 2; x + 2 < image.width(); ++x) {
      const float weight = grid.weight(x, y);
      const Texel& texel = image(x, y);
      if (!(weight > 0) || !(texel.valid > 0.5f)) continue;
      const float idepth = grid.weighted(x, y) / weight;
      if (!(idepth > 0)) continue;
      points.u.push_back(static_cast<float>(x));
      points.v.push_back(static_cast<float>(y));
      points.idepth.push_back(idepth);
      points.intensity.push_back(texel.intensity);
    }
  }
  return points;
}

/// Where `point` of `host` lies in the newest keyframe at the current estimate.
bool project_sample(const PatternWarp& warp, const ActivePoint& point, DepthSample& sample) {
  const PixelWarp w = warp_at(warp, point.u, point.v, point.idepth);
  float p[3];
  for (int r = 0; r < 3; ++r) {
    p[r] = w.KRKi[3 * r] * point.u + w.KRKi[3 * r + 1] * point.v + w.KRKi[3 * r + 2] + w.Kt[r] * point.idepth;
  }
  if (!(p[2] > 0)) return false;
  sample.u = p[0] / p[2];
  sample.v = p[1] / p[2];
  sample.idepth = point.idepth / p[2];
  return sample.idepth > 0;
}

}  // namespace

CoarseDepthMap make_coarse_depth_map(const Window& window) {
  const Keyframe& newest = *window.keyframes.back();
  std::vector<DepthSample> samples;
  for (const auto& host : window.keyframes) {
    PatternWarp warp;
    const bool own = host.get() == &newest;
    if (!own) {
      const SE3d T_newest_host = newest.state.T_c_w() * host->state.T_c_w().inverse();
      warp = make_warp(T_newest_host, window.camera, {}, newest.image());
      add_readout(T_newest_host, window.camera, window.readout(*host), window.readout(newest), warp);
    }
    for (const ActivePoint& point : host->points) {
      const float weight = std::sqrt(1e-3f * std::max(point.idepth_hessian, 1e-3f));
      DepthSample sample{point.u, point.v, point.idepth, weight};
      if (own) {
        if (point.idepth > 0) samples.push_back(sample);
        continue;
      }
      bool seen = false;
      for (const PointResidual& r : point.residuals) {
        seen = seen || (r.target == &newest && r.states[window.front] == ResidualState::kInlier);
      }
      if (seen && project_sample(warp, point, sample)) samples.push_back(sample);
    }
  }
  return make_coarse_depth_map(samples, newest.frame->pyramid);
}

CoarseDepthMap make_coarse_depth_map(const std::vector<DepthSample>& samples, const ImagePyramid& reference) {
  CoarseDepthMap map;
  std::vector<DepthGrid> grids;
  for (const Image<Texel>& image : reference.levels) {
    grids.push_back(grids.empty() ? splat(samples, image.width(), image.height())
                                  : halve(grids.back(), image.width(), image.height()));
  }
  double sum = 0;
  for (const DepthSample& s : samples) sum += s.idepth;
  if (!samples.empty()) map.mean_idepth = sum / static_cast<double>(samples.size());
  for (std::size_t level = 0; level < grids.size(); ++level) {
    dilate(grids[level], level < 2);
    map.levels.push_back(collect(grids[level], reference.levels[level]));
  }
  return map;
}

}  // namespace ldso
