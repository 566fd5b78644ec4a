#include "scaling/triangulated_tag.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

constexpr std::size_t kLeastViews = 3;
constexpr int kRounds = 15;

/// Errors of more standard deviations than this are pulled with less weight (Huber).
constexpr double kHuber = 2;

struct Corner {
  Eigen::Vector3d position;
  Eigen::Matrix3d covariance;
};

/// Where the rays meet, by their distances from it.
std::optional<Eigen::Vector3d> nearest_to_rays(const std::vector<TagView>& views, std::size_t corner) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const TagView& view : views) {
    const Eigen::Vector3d d = view.T_world_camera.rotation() * view.rays[corner];
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    A += across;
    b += across * view.T_world_camera.translation();
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(A);
  if (solver.info() != Eigen::Success || solver.rcond() < 1e-12) return std::nullopt;
  return solver.solve(b);
}

/// By the angles between the rays and the directions to the point; the errors themselves say how large they are.
std::optional<Corner> triangulate(const std::vector<TagView>& views, std::size_t corner) {
  const std::optional<Eigen::Vector3d> start = nearest_to_rays(views, corner);
  if (!start) return std::nullopt;
  Corner result{*start, Eigen::Matrix3d::Identity()};
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double squares = 0, weights = 0;
    for (const TagView& view : views) {
      const Eigen::Vector3d d = view.T_world_camera.rotation() * view.rays[corner];
      const Eigen::Vector3d to = result.position - view.T_world_camera.translation();
      const double depth = to.dot(d);
      if (!(depth > 0)) return std::nullopt;
      const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - d * d.transpose()) / (depth * view.ray_stddev);
      const Eigen::Vector3d error = across * to;
      const double size = error.norm(), weight = size <= kHuber ? 1 : kHuber / size;
      H += weight * across.transpose() * across;
      b += weight * across.transpose() * error;
      squares += weight * size * size;
      weights += weight;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(H);
    if (solver.info() != Eigen::Success || solver.rcond() < 1e-14) return std::nullopt;
    result.position -= solver.solve(b);
    const double excess = std::max(1.0, squares / std::max(1.0, 2 * weights - 3));
    result.covariance = excess * H.inverse();
  }
  return result.position.allFinite() ? std::optional(result) : std::nullopt;
}

/// Of a side between two corners, whose errors are taken for those of one and the same motion.
double side_stddev(const Corner& a, const Corner& b) {
  const Eigen::Vector3d along = (a.position - b.position).normalized();
  return std::sqrt(along.dot((a.covariance + b.covariance) * along));
}

}  // namespace

std::optional<TriangulatedTag> triangulate_tag(const std::vector<TagView>& views) {
  if (views.size() < kLeastViews) return std::nullopt;
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::optional<Corner> corner = triangulate(views, i);
    if (!corner) return std::nullopt;
    corners.push_back(*corner);
  }
  // The square nearest to four points that go round has half the diagonals of their quadrilateral on average.
  const auto between = [&](std::size_t a, std::size_t b) { return (corners[a].position - corners[b].position).norm(); };
  double sides = 0, squares = 0, deviations = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = between(i, (i + 1) % 4);
    sides += side / 4;
    squares += side * side / 4;
    deviations += side_stddev(corners[i], corners[(i + 1) % 4]) / 4;
  }
  const double side = (sides + (between(0, 2) + between(1, 3)) / (2 * std::sqrt(2.0))) / 2;
  if (!(side > 0)) return std::nullopt;
  const double spread = std::sqrt(std::max(0.0, squares - sides * sides));  // Of sides that should be equal.
  return TriangulatedTag{side, std::hypot(deviations / 2, spread / 2) / side};
}

}  // namespace ldso
