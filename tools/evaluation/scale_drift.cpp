#include "evaluation/scale_drift.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/umeyama.h"

namespace ldso {
namespace {

constexpr std::size_t kLeastPairs = 9;
constexpr double kLeastRelativeSpread = 1e-3;  ///< Of a third, relative to the whole.

struct Positions {
  std::vector<Eigen::Vector3d> estimate, truth;
};

Positions positions_of(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs, std::size_t begin,
                       std::size_t end) {
  Positions positions;
  for (std::size_t i = begin; i < end; ++i) {
    positions.estimate.push_back(estimate[pairs[i].estimate].T_world_camera.translation());
    positions.truth.push_back(truth[pairs[i].truth].T_world_camera.translation());
  }
  return positions;
}

/// Root mean square distance from the centroid.
double spread_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double sum = 0;
  for (const Eigen::Vector3d& p : points) sum += (p - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

bool moves(const Positions& part, const Positions& whole) {
  const auto enough = [](double part_spread, double whole_spread) {
    return part_spread > kLeastRelativeSpread * whole_spread;
  };
  return enough(spread_of(part.estimate), spread_of(whole.estimate)) &&
         enough(spread_of(part.truth), spread_of(whole.truth));
}

}  // namespace

std::optional<ScaleDrift> scale_drift(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs) {
  const std::size_t n = pairs.size();
  if (n < kLeastPairs) return std::nullopt;
  const Positions whole = positions_of(estimate, truth, pairs, 0, n);
  const Positions first = positions_of(estimate, truth, pairs, 0, n / 3);
  const Positions last = positions_of(estimate, truth, pairs, n - n / 3, n);
  if (!moves(first, whole) || !moves(last, whole)) return std::nullopt;

  ScaleDrift result;
  // A third may be a straight line, which has a scale (the same as that of Sim(3)) but no rotation.
  result.first_scale = umeyama(first.estimate, first.truth, AlignmentMode::kScale).scale();
  result.last_scale = umeyama(last.estimate, last.truth, AlignmentMode::kScale).scale();
  result.ratio = result.last_scale / result.first_scale;
  result.drift = std::max(result.ratio, 1.0 / result.ratio);
  return result;
}

}  // namespace ldso
