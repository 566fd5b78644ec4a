#include "odometry/init/joint_level.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/interpolation.h"
#include "odometry/init/patch_tracker.h"
#include "odometry/state/robust_weight.h"
#include "util/median.h"

namespace ldso {
namespace {

/// A point whose root mean square residual exceeds that of the median point so many times pulls no more: it straddles a
/// step in depth.
constexpr double kOutlierFactor = 2.5;
/// A point whose root mean square residual is below this is none of those [grey levels].
constexpr double kMinOutlier = 5.0;
/// Least depth in the second view over depth in the first.
constexpr double kMinRatio = 0.05;
/// The pixel of the pattern that is the point itself.
constexpr int kCentre = 4;

using JointStepf = Eigen::Matrix<float, 8, 1>;

bool sample(const Image<Texel>& image, float x, float y, Texel& out) {
  if (!is_interpolable(image.view(), x, y)) return false;
  out = bilinear(image.view(), x, y);
  return out.valid != 0;
}

float gradient_weight(const Texel& s) {
  const float c2 = kGradientWeight * kGradientWeight;
  return c2 / (c2 + s.dx * s.dx + s.dy * s.dy);
}

}  // namespace

JointState moved(const JointState& state, const JointStep& step) {
  JointState result = state;
  const SO3d rotation = SO3d::exp(step.segment<3>(3));
  result.T_second_first =
      SE3d(rotation * state.T_second_first.rotation(), rotation * state.T_second_first.translation() + step.head<3>());
  result.a += step[6];
  result.b += step[7];
  return result;
}

struct JointLevel::Accumulator {
  float energy = 0, squared = 0, h_dd = 0, b_d = 0;
  JointStepf h_dx = JointStepf::Zero();
  JointStepf b_x = JointStepf::Zero();
  Eigen::Matrix<float, 8, 8> h_xx = Eigen::Matrix<float, 8, 8>::Zero();
  std::array<float, kPatternSize> residuals;
};

JointLevel::JointLevel(const PreparedFrame& first, const PreparedFrame& second,
                       const std::vector<Eigen::Vector2d>& pixels, const PinholeIntrinsics& camera, int level,
                       ThreadPool& pool)
    : second_(second.pyramid.levels[level]),
      camera_(level_intrinsics(camera, level)),
      exposure_ratio_(second.exposure_ms / first.exposure_ms),
      hosts_(pixels.size()) {
  pool.for_chunks(static_cast<int>(pixels.size()), kJointPointsAtOnce, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      hosts_[i] = make_host(first.pyramid.levels[level], to_level(pixels[i], level));
    }
  });
}

void JointLevel::set_outlier_limit(const JointState& state) {
  outlier_rms_ = std::numeric_limits<double>::infinity();
  std::vector<double> rms;
  for (int i = 0; i < points(); ++i) {
    const JointPointSystem system = linearize(i, state);
    if (system.visible) rms.push_back(system.rms);
  }
  outlier_rms_ = rms.empty() ? kMinOutlier : std::max(kMinOutlier, kOutlierFactor * upper_median(rms));
}

JointPointSystem JointLevel::linearize(int index, const JointState& state, std::vector<float>* residuals) const {
  const HostPoint& host = hosts_[index];
  JointPointSystem system;
  system.energy = kPatternSize * outlier_rms_ * outlier_rms_;
  if (!host.usable) return system;
  const Eigen::Matrix3f R = state.T_second_first.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = state.T_second_first.translation().cast<float>();
  const float idepth = static_cast<float>(state.idepth[index]);
  const float factor = static_cast<float>(exposure_ratio_ * std::exp(state.a));
  Accumulator sums;
  for (int k = 0; k < kPatternSize; ++k) {
    if (!add_pixel(host, k, R, t, idepth, factor, static_cast<float>(state.b), sums)) return system;
  }
  system.visible = true;
  system.rms = std::sqrt(sums.squared / kPatternSize);
  if (residuals != nullptr) residuals->insert(residuals->end(), sums.residuals.begin(), sums.residuals.end());
  system.outlier = sums.squared > system.energy;
  if (system.outlier) return system;
  system.energy = sums.energy;
  system.h_dd = sums.h_dd;
  system.b_d = sums.b_d;
  system.h_dx = sums.h_dx.cast<double>();
  system.h_xx = sums.h_xx.cast<double>();
  system.b_x = sums.b_x.cast<double>();
  return system;
}

double JointLevel::parallax(int index, const JointState& state) const {
  const HostPoint& host = hosts_[index];
  if (!host.usable) return 0;
  const Eigen::Vector3d q0 = state.T_second_first.rotation() * Eigen::Vector3d(host.rays[kCentre].cast<double>());
  const Eigen::Vector3d q = q0 + state.idepth[index] * state.T_second_first.translation();
  if (q.z() < kMinRatio || q0.z() < kMinRatio) return 0;
  return std::hypot(camera_.fx * (q.x() / q.z() - q0.x() / q0.z()), camera_.fy * (q.y() / q.z() - q0.y() / q0.z()));
}

JointLevel::HostPoint JointLevel::make_host(const Image<Texel>& image, const Eigen::Vector2d& centre) const {
  HostPoint host;
  for (int k = 0; k < kPatternSize; ++k) {
    const float x = static_cast<float>(centre.x()) + static_cast<float>(kPattern[k].dx);
    const float y = static_cast<float>(centre.y()) + static_cast<float>(kPattern[k].dy);
    Texel texel;
    if (!sample(image, x, y, texel)) return host;
    host.rays[k] = Eigen::Vector3f((x - static_cast<float>(camera_.cx)) / static_cast<float>(camera_.fx),
                                   (y - static_cast<float>(camera_.cy)) / static_cast<float>(camera_.fy), 1);
    host.intensity[k] = texel.intensity;
    host.weight[k] = gradient_weight(texel);
  }
  host.usable = true;
  return host;
}

bool JointLevel::add_pixel(const HostPoint& host, int k, const Eigen::Matrix3f& R, const Eigen::Vector3f& t,
                           float idepth, float factor, float offset, Accumulator& sums) const {
  const Eigen::Vector3f q = R * host.rays[k] + idepth * t;
  if (!(q.z() > static_cast<float>(kMinRatio))) return false;
  const float fx = static_cast<float>(camera_.fx);
  const float fy = static_cast<float>(camera_.fy);
  const float iz = 1 / q.z();
  const float X = q.x() * iz;
  const float Y = q.y() * iz;
  Texel s;
  if (!sample(second_, fx * X + static_cast<float>(camera_.cx), fy * Y + static_cast<float>(camera_.cy), s)) {
    return false;
  }
  const float r = s.intensity - factor * host.intensity[k] - offset;
  const float huber = huber_weight(r);
  const float weight = 0.5f * (host.weight[k] + gradient_weight(s)) * huber;
  const float gx = s.dx * fx * iz;
  const float gy = s.dy * fy * iz;
  const Eigen::Vector3f J_q(gx, gy, -gx * X - gy * Y);
  JointStepf J;
  J.head<3>() = J_q * idepth;
  J.segment<3>(3) = q.cross(J_q);
  J[6] = -factor * host.intensity[k];
  J[7] = -1;
  const float J_d = J_q.dot(t);
  sums.residuals[k] = r;
  sums.energy += weight * r * r * (2 - huber);
  sums.squared += r * r;
  sums.h_dd += weight * J_d * J_d;
  sums.b_d += weight * J_d * r;
  sums.h_dx += weight * J_d * J;
  sums.b_x += weight * r * J;
  sums.h_xx.noalias() += weight * J * J.transpose();
  return true;
}

}  // namespace ldso
