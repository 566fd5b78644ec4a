#include "evaluation/alignment.h"

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::array<std::pair<AlignmentMode, const char*>, 4> kModeNames = {{{AlignmentMode::kSe3, "se3"},
                                                                              {AlignmentMode::kSim3, "sim3"},
                                                                              {AlignmentMode::kScale, "scale"},
                                                                              {AlignmentMode::kNone, "none"}}};

/// Of the second singular value of the cross covariance to the first, from here on down the rotation is open.
constexpr double kLineRatio = 1e-10;
/// Length of the arms that make it determined, relative to the extent; their square stays in the solution.
constexpr double kArmLength = 1e-4;

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d centroid(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double spread(const Points& points) {
  const Eigen::Vector3d centre = centroid(points);
  double sum = 0;
  for (const Eigen::Vector3d& p : points) sum += (p - centre).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

bool on_a_line(const Points& from, const Points& to) {
  const Eigen::Vector3d from_centre = centroid(from), to_centre = centroid(to);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    covariance += (to[i] - to_centre) * (from[i] - from_centre).transpose();
  }
  const Eigen::Vector3d d = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  return d[1] <= kLineRatio * d[0];
}

/// Points at the ends of short arms along the axes of the camera, in both directions so that the centroid stays.
void append_arms(const SE3d& T_world_camera, double length, Points& points) {
  const Eigen::Matrix3d R = T_world_camera.rotation_matrix();
  for (int axis = 0; axis < 3; ++axis) {
    points.push_back(T_world_camera.translation() + length * R.col(axis));
    points.push_back(T_world_camera.translation() - length * R.col(axis));
  }
}

}  // namespace

Sim3d align_pairs(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs, AlignmentMode mode) {
  if (pairs.empty()) throw Error("alignment", "there are no pairs of poses", "");
  Points from, to;
  for (const PosePair& pair : pairs) {
    from.push_back(estimate[pair.estimate].T_world_camera.translation());
    to.push_back(truth[pair.truth].T_world_camera.translation());
  }
  const bool rotates = mode == AlignmentMode::kSe3 || mode == AlignmentMode::kSim3;
  if (rotates && pairs.size() >= 3 && on_a_line(from, to)) {
    const double from_arm = kArmLength * spread(from), to_arm = kArmLength * spread(to);
    for (const PosePair& pair : pairs) {
      append_arms(estimate[pair.estimate].T_world_camera, from_arm, from);
      append_arms(truth[pair.truth].T_world_camera, to_arm, to);
    }
  }
  return umeyama(from, to, mode);
}

SE3d apply_alignment(const Sim3d& S_truth_estimate, const SE3d& T_world_camera) {
  return SE3d(S_truth_estimate.rotation() * T_world_camera.rotation(), S_truth_estimate * T_world_camera.translation());
}

std::string to_string(AlignmentMode mode) {
  for (const auto& [value, name] : kModeNames) {
    if (value == mode) return name;
  }
  return "unknown";
}

AlignmentMode parse_alignment_mode(const std::string& name) {
  for (const auto& [value, known] : kModeNames) {
    if (name == known) return value;
  }
  throw Error("alignment", "unknown mode \"" + name + "\"", "choose se3, sim3, scale or none");
}

}  // namespace ldso
