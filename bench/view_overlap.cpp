#include "view_overlap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "util/median.h"

namespace ldso {
namespace {

constexpr std::size_t kLeastPoints = 15;
constexpr int kMaxHamming = 50;
constexpr double kMinParallax = 0.01;  // [rad]
constexpr double kMaxError = 2.0;      // [px]

Eigen::Vector3d ray_of(const Feature& f, const PinholeIntrinsics& camera) {
  return {(static_cast<double>(f.u) - camera.cx) / camera.fx, (static_cast<double>(f.v) - camera.cy) / camera.fy, 1};
}

Eigen::Vector2d project(const Eigen::Vector3d& p, const PinholeIntrinsics& camera) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

const Feature* nearest(const Feature& feature, const std::vector<Feature>& others) {
  const Feature* best = nullptr;
  int distance = kMaxHamming;
  for (const Feature& other : others) {
    const int d = hamming_distance(feature.descriptor, other.descriptor);
    if (d >= distance) continue;
    distance = d;
    best = &other;
  }
  return best;
}

std::optional<double> triangulate(const Feature& a, const Feature& b, const SE3d& T_b_a,
                                  const PinholeIntrinsics& camera) {
  const Eigen::Vector3d ray = T_b_a.rotation() * ray_of(a, camera), other = ray_of(b, camera);
  const Eigen::Vector3d normal = other.cross(ray);
  if (normal.norm() < kMinParallax * ray.norm() * other.norm()) return {};
  const double depth = -normal.dot(other.cross(T_b_a.translation())) / normal.squaredNorm();
  const Eigen::Vector3d point = depth * ray + T_b_a.translation();
  if (!(depth > 0) || !(point.z() > 0)) return {};
  const Eigen::Vector2d pixel(static_cast<double>(b.u), static_cast<double>(b.v));
  if ((project(point, camera) - pixel).norm() > kMaxError) return {};
  return depth;
}

}  // namespace

std::optional<double> median_depth(const std::vector<Feature>& a, const std::vector<Feature>& b, const SE3d& T_b_a,
                                   const PinholeIntrinsics& camera) {
  std::vector<double> depths;
  for (const Feature& feature : a) {
    const Feature* match = nearest(feature, b);
    if (match == nullptr || nearest(*match, a) != &feature) continue;
    if (const auto depth = triangulate(feature, *match, T_b_a, camera)) depths.push_back(*depth);
  }
  if (depths.size() < kLeastPoints) return {};
  return upper_median(depths);
}

double overlap(const SE3d& T_b_a, double depth, const PinholeIntrinsics& camera) {
  constexpr int kColumns = 8, kRows = 6;
  int seen = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const double u = (i % kColumns + 0.5) * camera.width / kColumns;
    const double v = (std::floor(i / kColumns) + 0.5) * camera.height / kRows;
    const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
    for (const double factor : {0.5, 1.0, 2.0}) {
      const Eigen::Vector3d p = T_b_a * Eigen::Vector3d(factor * depth * ray);
      if (p.z() < factor * depth / 2 || p.z() > factor * depth * 2) continue;
      const Eigen::Vector2d pixel = project(p, camera);
      seen += pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width - 1 && pixel.y() <= camera.height - 1;
    }
  }
  return seen / (3.0 * kColumns * kRows);
}

}  // namespace ldso
