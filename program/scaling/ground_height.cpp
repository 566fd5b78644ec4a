#include "scaling/ground_height.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "util/median.h"

namespace ldso {
namespace {

/// Keyframes that share a plane, and from one such stretch to the next.
constexpr std::size_t kKeyframes = 24;
constexpr std::size_t kStep = 8;

// Points that may be ground: below the horizon, and not far to the sides, where pavements and verges are.
constexpr double kLeastSlope = 0.09;     // downwards, per unit of depth
constexpr double kMostSideways = 1.6;    // per unit downwards
constexpr double kMostDeviation = 0.15;  // relative standard deviation of the inverse depth

constexpr std::size_t kLeastPoints = 40;
constexpr int kTrials = 400;
constexpr int kFitRounds = 10;
constexpr double kMostClimb = 0.3;      // of the motion towards the image's vertical
constexpr double kMostTilt = 0.25;      // of the plane's normal from the image's vertical
constexpr double kTolerance = 0.04;     // of inverse depths, relative
constexpr double kLeastInliers = 0.35;  // share of the points
constexpr std::size_t kLeastStretches = 3;
constexpr double kLeastCoverage = 0.2;  // of the stretches

/// A point by its direction (x, y, 1) and its inverse depth.
struct GroundPoint {
  Eigen::Vector3d direction;
  double idepth = 0, stddev = 0;
};

/// Unit of a keyframe in units of the world.
double unit_of(const SlamResult& result, std::size_t keyframe) {
  return result.corrected.empty() ? 1 : result.corrected[keyframe].scale();
}

/// Indices of the keyframes of the main map, whose poses are given: others have units of their own.
std::vector<std::size_t> main_keyframes(const SlamResult& result, const std::vector<TimedPose>& poses) {
  std::set<std::int64_t> ids;
  for (const TimedPose& pose : poses) ids.insert(pose.frame_id);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < result.keyframes.size(); ++i) {
    if (ids.contains(result.keyframes[i].frame_id)) indices.push_back(i);
  }
  return indices;
}

void add_points(const KeyframeUpdate& keyframe, double unit, std::vector<GroundPoint>& points) {
  const PinholeIntrinsics& c = keyframe.camera;
  for (const MapPoint& m : keyframe.points) {
    if (!(m.idepth > 0) || !(m.idepth_stddev < kMostDeviation * m.idepth)) continue;
    const Eigen::Vector3d direction((m.u - c.cx) / c.fx, (m.v - c.cy) / c.fy, 1);
    if (direction.y() < kLeastSlope || std::abs(direction.x()) > kMostSideways * direction.y()) continue;
    points.push_back({direction, m.idepth / unit, std::max<double>(m.idepth_stddev, 0.01 * m.idepth) / unit});
  }
}

/// The plane a with a . direction = idepth: its normal divided by its distance.
using Plane = Eigen::Vector3d;

/// What a vehicle drives along lies in the ground, which the odometry knows far better than points of the road would
/// tell: planes are combinations of these two columns, which are normal to the direction of motion.
using Normals = Eigen::Matrix<double, 3, 2>;

/// Mean direction in which the camera moves, in its own coordinates, over the keyframes [begin, end) of `poses`.
std::optional<Eigen::Vector3d> motion_in_camera(const std::vector<TimedPose>& poses, std::size_t begin,
                                                std::size_t end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = begin + 1; k + 1 < end; ++k) {
    const Eigen::Vector3d chord = poses[k + 1].T_world_camera.translation() - poses[k - 1].T_world_camera.translation();
    sum += poses[k].T_world_camera.rotation().inverse() * chord;
  }
  const double length = sum.norm();
  return length > 0 ? std::optional<Eigen::Vector3d>(sum / length) : std::nullopt;
}

Normals normals_to(const Eigen::Vector3d& motion) {
  Normals normals;
  normals.col(0) = (Eigen::Vector3d::UnitY() - motion.y() * motion).normalized();
  normals.col(1) = motion.cross(normals.col(0));
  return normals;
}

bool is_ground(const Plane& plane) {
  const double length = plane.norm();
  return plane.y() > 0 && std::hypot(plane.x(), plane.z()) < kMostTilt * length;
}

double relative_error(const Plane& plane, const GroundPoint& point) {
  return plane.dot(point.direction) / point.idepth - 1;
}

double agreement(const Plane& plane, const std::vector<GroundPoint>& points) {
  double sum = 0;
  for (const GroundPoint& point : points) {
    const double e = relative_error(plane, point) / kTolerance;
    sum += std::max(0.0, 1 - e * e);
  }
  return sum / static_cast<double>(points.size());
}

std::optional<Plane> sample_plane(const std::vector<GroundPoint>& points, const Normals& normals, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::optional<Plane> best;
  double best_agreement = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix2d A;
    Eigen::Vector2d b;
    for (int k = 0; k < 2; ++k) {
      const GroundPoint& point = points[random() % points.size()];
      A.row(k) = point.direction.transpose() * normals;
      b[k] = point.idepth;
    }
    const Eigen::FullPivLU<Eigen::Matrix2d> solver(A);
    if (!solver.isInvertible()) continue;
    const Plane plane = normals * solver.solve(b);
    if (!is_ground(plane)) continue;
    const double now = agreement(plane, points);
    if (now <= best_agreement) continue;
    best_agreement = now;
    best = plane;
  }
  return best;
}

/// Least squares with weights that vanish for what is no ground (Tukey).
Plane refine(Plane plane, const Normals& normals, const std::vector<GroundPoint>& points) {
  for (int round = 0; round < kFitRounds; ++round) {
    Eigen::Matrix2d H = Eigen::Matrix2d::Identity() * 1e-12;
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (const GroundPoint& point : points) {
      const double e = relative_error(plane, point) / (2 * kTolerance);
      if (std::abs(e) >= 1) continue;
      const double weight = (1 - e * e) * (1 - e * e) / (point.stddev * point.stddev);
      const Eigen::Vector2d across = normals.transpose() * point.direction;
      H += weight * across * across.transpose();
      b += weight * point.idepth * across;
    }
    plane = normals * H.ldlt().solve(b);
  }
  return plane;
}

/// Height above the ground of one stretch, if there is ground.
std::optional<double> height_of(const std::vector<GroundPoint>& points, const Eigen::Vector3d& motion,
                                std::uint64_t seed) {
  if (points.size() < kLeastPoints || std::abs(motion.y()) > kMostClimb) return std::nullopt;
  const Normals normals = normals_to(motion);
  const std::optional<Plane> start = sample_plane(points, normals, seed);
  if (!start) return std::nullopt;
  const Plane plane = refine(*start, normals, points);
  if (!plane.allFinite() || !is_ground(plane) || agreement(plane, points) < kLeastInliers) return std::nullopt;
  return 1 / plane.norm();
}

/// A stretch of the way with ground: its place among all and its height.
struct Stretch {
  double place = 0;
  double log_height = 0;
};

/// A line through the logarithms of the heights, which outliers do not move (Theil-Sen).
struct Trend {
  double slope = 0;  ///< Per stretch.
  double level = 0;  ///< In the middle of the way.
};

Trend trend_of(const std::vector<Stretch>& stretches, double middle) {
  std::vector<double> slopes, levels;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    for (std::size_t j = i + 1; j < stretches.size(); ++j)
      slopes.push_back((stretches[j].log_height - stretches[i].log_height) / (stretches[j].place - stretches[i].place));
  }
  Trend trend;
  if (!slopes.empty()) trend.slope = median_of(slopes);
  for (const Stretch& stretch : stretches)
    levels.push_back(stretch.log_height - trend.slope * (stretch.place - middle));
  trend.level = median_of(levels);
  return trend;
}

/// Standard deviation of the level: stretches overlap, so that a part of them is independent.
double deviation_of(const std::vector<Stretch>& stretches, const Trend& trend, double middle) {
  std::vector<double> errors;
  for (const Stretch& stretch : stretches)
    errors.push_back(std::abs(stretch.log_height - trend.level - trend.slope * (stretch.place - middle)));
  const double independent = static_cast<double>(stretches.size() * kStep) / kKeyframes;
  return 1.4826 * 1.2533 * median_of(errors) / std::sqrt(std::max(1.0, independent));
}

}  // namespace

std::optional<GroundHeight> measure_ground(const SlamResult& result) {
  std::vector<Stretch> stretches;
  std::size_t count = 0;
  const std::vector<TimedPose> poses = result.keyframe_trajectory();
  const std::vector<std::size_t> keyframes = main_keyframes(result, poses);
  for (std::size_t begin = 0; begin < keyframes.size(); begin += kStep) {
    std::vector<GroundPoint> points;
    const std::size_t end = std::min(keyframes.size(), begin + kKeyframes);
    for (std::size_t k = begin; k < end; ++k)
      add_points(result.keyframes[keyframes[k]], unit_of(result, keyframes[k]), points);
    const std::optional<Eigen::Vector3d> motion = motion_in_camera(poses, begin, end);
    const std::optional<double> height = motion ? height_of(points, *motion, begin) : std::nullopt;
    if (height) stretches.push_back({static_cast<double>(count), std::log(*height)});
    ++count;
  }
  const double found = static_cast<double>(stretches.size()), all = static_cast<double>(count);
  if (stretches.size() < kLeastStretches || found < kLeastCoverage * all) return std::nullopt;
  const double middle = 0.5 * (all - 1);
  const Trend trend = trend_of(stretches, middle);
  GroundHeight ground;
  ground.height = std::exp(trend.level);
  ground.growth = std::exp(trend.slope * (all - 1));
  ground.relative_stddev = deviation_of(stretches, trend, middle);
  ground.stretches = static_cast<int>(stretches.size());
  return ground;
}

}  // namespace ldso
