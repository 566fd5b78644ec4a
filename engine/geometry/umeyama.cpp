#include "geometry/umeyama.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

using Points = std::vector<Eigen::Vector3d>;

[[noreturn]] void fail_alignment(const std::string& problem, const std::string& remedy) {
  throw Error("alignment of two trajectories", problem, remedy);
}

void require_finite(const Points& points, const char* name) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      fail_alignment("position " + std::to_string(i) + " of the " + name + " set is not finite",
                     "remove or repair that pose");
    }
  }
}

/// First and second moments of two point sets.
struct Moments {
  Eigen::Vector3d mean_from = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_to = Eigen::Vector3d::Zero();
  double variance_from = 0;
  double variance_to = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< E[(to - mean) (from - mean)^T]
};

Moments compute_moments(const Points& from, const Points& to) {
  Moments m;
  const double weight = 1.0 / static_cast<double>(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    m.mean_from += weight * from[i];
    m.mean_to += weight * to[i];
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d d_from = from[i] - m.mean_from;
    const Eigen::Vector3d d_to = to[i] - m.mean_to;
    m.variance_from += weight * d_from.squaredNorm();
    m.variance_to += weight * d_to.squaredNorm();
    m.covariance += weight * d_to * d_from.transpose();
  }
  return m;
}

/// Whether a set's spread is more than the rounding of its coordinates.
bool moves(double variance, const Points& points) {
  double largest = 0;
  for (const Eigen::Vector3d& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return std::sqrt(variance) > 16 * std::numeric_limits<double>::epsilon() * largest;
}

void require_alignable(const Points& from, const Points& to) {
  if (from.size() != to.size()) {
    fail_alignment("the sets have " + std::to_string(from.size()) + " and " + std::to_string(to.size()) + " positions",
                   "associate them by time first");
  }
  if (from.size() < 3) {
    fail_alignment("only " + std::to_string(from.size()) + " pairs of positions, at least 3 are needed",
                   "check that the timestamps of both overlap, or align with mode none");
  }
  require_finite(from, "first");
  require_finite(to, "second");
}

}  // namespace

Sim3d umeyama(const Points& from, const Points& to, AlignmentMode mode) {
  if (mode == AlignmentMode::kNone) return Sim3d();
  require_alignable(from, to);
  const Moments m = compute_moments(from, to);
  if (!moves(m.variance_from, from) || !moves(m.variance_to, to)) {
    fail_alignment("all positions of one set are the same", "align with mode none");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& d = svd.singularValues();
  if (mode != AlignmentMode::kScale && d[1] <= 1e-12 * d[0]) {
    fail_alignment("the positions are on a line, the rotation about it is not determined",
                   "align with mode scale or none");
  }
  // Umeyama's S (eq. 43): the best rotation where the best orthogonal matrix would be a reflection.
  const bool reflection = svd.matrixU().determinant() * svd.matrixV().determinant() < 0;
  const Eigen::Vector3d signs(1, 1, reflection ? -1 : 1);
  const double scale = mode == AlignmentMode::kSe3 ? 1.0 : d.dot(signs) / m.variance_from;
  if (!(scale > 0)) fail_alignment("the sets are uncorrelated, their scale is not determined", "align with mode none");
  if (mode == AlignmentMode::kScale) return Sim3d(SO3d(), Eigen::Vector3d::Zero(), scale);
  const SO3d R = SO3d::from_matrix(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose());
  return Sim3d(R, m.mean_to - scale * (R * m.mean_from), scale);
}

}  // namespace ldso
