#include "odometry/tracking/coarse_depth_map.h"

#include <array>
#include <cmath>

#include "odometry/residual/photometric_residual.h"

namespace ldso {
namespace {

/// Inverse depths that fell into one pixel, or were lent to it by its neighbours.
struct DepthCell {
  float weighted = 0;  ///< Sum of idepth * weight.
  float weight = 0;    ///< Sum of weights; 0: no depth.
};

/// Weighted inverse depths of one level. Few pixels have one: those are listed.
struct DepthGrid {
  DepthGrid(int width, int height) : cells(width, height) {}

  void add(int x, int y, float weighted, float weight) {
    DepthCell& cell = cells(x, y);
    if (cell.weight == 0) occupied.push_back({x, y});
    cell.weighted += weighted;
    cell.weight += weight;
  }

  struct Pixel {
    int x = 0, y = 0;
  };
  Image<DepthCell> cells;
  std::vector<Pixel> occupied;
};

DepthGrid splat(const std::vector<DepthSample>& samples, int width, int height) {
  DepthGrid grid(width, height);
  for (const DepthSample& s : samples) {
    // Not lround, a slow call: truncation is wrong for negative numbers only, in columns and rows collect() leaves out.
    const float u = s.u + 0.5f, v = s.v + 0.5f;
    if (!(u > -1 && v > -1 && u < static_cast<float>(width) && v < static_cast<float>(height))) continue;
    grid.add(static_cast<int>(u), static_cast<int>(v), s.idepth * s.weight, s.weight);
  }
  return grid;
}

DepthGrid halve(const DepthGrid& fine, int width, int height) {
  DepthGrid grid(width, height);
  for (const auto [x, y] : fine.occupied) {
    const DepthCell& cell = fine.cells(x, y);
    if (x / 2 < width && y / 2 < height) grid.add(x / 2, y / 2, cell.weighted, cell.weight);
  }
  return grid;
}

/// Gives pixels without depth the mean of their four neighbours with depth: diagonal ones on the fine levels, where
/// points lie sparse, direct ones on the coarse.
void dilate(DepthGrid& grid, bool diagonal) {
  using Step = DepthGrid::Pixel;
  const std::array<Step, 4> steps = diagonal ? std::array<Step, 4>{{{1, 1}, {-1, -1}, {-1, 1}, {1, -1}}}
                                             : std::array<Step, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const int width = grid.cells.width(), height = grid.cells.height();
  // What is lent has a negative weight until all is lent: it is lent on to nobody.
  std::vector<DepthGrid::Pixel> lent;
  for (const DepthGrid::Pixel pixel : grid.occupied) {
    for (const Step step : steps) {
      const int x = pixel.x + step.x, y = pixel.y + step.y;
      if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height || grid.cells(x, y).weight != 0) continue;
      DepthCell sum;
      int neighbours = 0;
      for (const Step other : steps) {
        const DepthCell& neighbour = grid.cells(x + other.x, y + other.y);
        if (!(neighbour.weight > 0)) continue;
        sum.weighted += neighbour.weighted;
        sum.weight += neighbour.weight;
        ++neighbours;
      }
      grid.cells(x, y) = {sum.weighted / static_cast<float>(neighbours), -sum.weight / static_cast<float>(neighbours)};
      lent.push_back({x, y});
    }
  }
  for (const auto [x, y] : lent) grid.cells(x, y).weight *= -1;
}

AlignmentPoints collect(const DepthGrid& grid, const Image<Texel>& image) {
  AlignmentPoints points;
  for (int y = 2; y + 2 < image.height(); ++y) {
    for (int x = 2; x + 2 < image.width(); ++x) {
      const auto [weighted, weight] = grid.cells(x, y);
      if (!(weight > 0)) continue;
      const Texel& texel = image(x, y);
      if (!(texel.valid > 0.5f)) continue;
      const float idepth = weighted / weight;
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
