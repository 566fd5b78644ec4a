#include "odometry/init/joint_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/interpolation.h"
#include "odometry/init/patch_tracker.h"
#include "odometry/state/residual_pattern.h"
#include "odometry/state/robust_weight.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Points that a thread takes at once.
constexpr int kChunk = 64;
/// Steps on each level.
constexpr int kIterations = 10;
/// A point whose root mean square residual exceeds that of the median point so many times pulls no more: it straddles a
/// step in depth.
constexpr double kOutlierFactor = 2.5;
/// If it also exceeds this [grey levels].
constexpr double kMinOutlier = 5.0;
/// Of a residual, for the weight of the prior on inverse depths [grey levels].
constexpr double kPriorNoise = 5.0;
/// Standard deviation of an inverse depth about its neighbours' median, relative to that.
constexpr double kPriorSpread = 0.5;
/// Least depth in the second view over depth in the first.
constexpr double kMinRatio = 0.05;

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Vector8f = Eigen::Matrix<float, 8, 1>;

bool sample(const Image<Texel>& image, float x, float y, Texel& out) {
  if (!is_interpolable(image.view(), x, y)) return false;
  out = bilinear(image.view(), x, y);
  return out.valid != 0;
}

/// A point as the first frame shows it on one level.
struct HostPoint {
  bool usable = false;
  std::array<Eigen::Vector3f, kPatternSize> rays;
  std::array<float, kPatternSize> intensity;
  std::array<float, kPatternSize> weight;
};

/// One point's share of the normal equations, its inverse depth eliminated by the caller.
struct PointSystem {
  bool visible = false;
  bool outlier = false;
  double energy = 0;
  double rms = 0;
  double h_dd = 0;
  double b_d = 0;
  Vector8 h_dx = Vector8::Zero();
  Matrix8 h_xx = Matrix8::Zero();
  Vector8 b_x = Vector8::Zero();
};

struct ReducedSystem {
  Matrix8 H = Matrix8::Zero();
  Vector8 b = Vector8::Zero();
  double energy = 0;
};

/// The eliminated part of a point, kept for the back substitution.
struct PointElimination {
  double h_dd = 0;
  double b_d = 0;
  Vector8 h_dx = Vector8::Zero();
};

float gradient_weight(const Texel& s) {
  const float c2 = kGradientWeight * kGradientWeight;
  return c2 / (c2 + s.dx * s.dx + s.dy * s.dy);
}

double median(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return upper_median(values);
}

/// The problem on one pyramid level.
class Level {
 public:
  Level(const PreparedFrame& first, const PreparedFrame& second, const std::vector<Eigen::Vector2d>& pixels,
        const PinholeIntrinsics& camera, int level, ThreadPool& pool)
      : second_(second.pyramid.levels[level]),
        camera_(level_intrinsics(camera, level)),
        exposure_ratio_(second.exposure_ms / first.exposure_ms),
        hosts_(pixels.size()) {
    pool.for_chunks(static_cast<int>(pixels.size()), kChunk, [&](int, int begin, int end) {
      for (int i = begin; i < end; ++i) {
        hosts_[i] = make_host(first.pyramid.levels[level], to_level(pixels[i], level));
      }
    });
  }

  /// Sets the limit beyond which points are outliers from their present residuals.
  void set_outlier_limit(const JointState& state) {
    outlier_rms_ = std::numeric_limits<double>::infinity();
    std::vector<double> rms;
    for (int i = 0; i < points(); ++i) {
      const PointSystem system = linearize(i, state);
      if (system.visible) rms.push_back(system.rms);
    }
    outlier_rms_ = rms.empty() ? kMinOutlier : std::max(kMinOutlier, kOutlierFactor * median(rms));
  }

  int points() const { return static_cast<int>(hosts_.size()); }
  const PinholeIntrinsics& camera() const { return camera_; }

  /// Appends the residuals to `residuals` if it is given.
  PointSystem linearize(int index, const JointState& state, std::vector<float>* residuals = nullptr) const {
    const HostPoint& host = hosts_[index];
    PointSystem system;
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

  /// Displacement by the translation, on this level [px].
  double parallax(int index, const JointState& state) const {
    const HostPoint& host = hosts_[index];
    if (!host.usable) return 0;
    const Eigen::Vector3d q0 = state.T_second_first.rotation() * Eigen::Vector3d(host.rays[4].cast<double>());
    const Eigen::Vector3d q = q0 + state.idepth[index] * state.T_second_first.translation();
    if (q.z() < kMinRatio || q0.z() < kMinRatio) return 0;
    return std::hypot(camera_.fx * (q.x() / q.z() - q0.x() / q0.z()), camera_.fy * (q.y() / q.z() - q0.y() / q0.z()));
  }

 private:
  struct Accumulator {
    float energy = 0, squared = 0, h_dd = 0, b_d = 0;
    Vector8f h_dx = Vector8f::Zero();
    Vector8f b_x = Vector8f::Zero();
    Eigen::Matrix<float, 8, 8> h_xx = Eigen::Matrix<float, 8, 8>::Zero();
    std::array<float, kPatternSize> residuals;
  };

  HostPoint make_host(const Image<Texel>& image, const Eigen::Vector2d& centre) const {
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

  bool add_pixel(const HostPoint& host, int k, const Eigen::Matrix3f& R, const Eigen::Vector3f& t, float idepth,
                 float factor, float offset, Accumulator& sums) const {
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
    Vector8f J;
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

  const Image<Texel>& second_;
  PinholeIntrinsics camera_;
  double exposure_ratio_;
  double outlier_rms_ = 0;
  std::vector<HostPoint> hosts_;
};

/// Levenberg-Marquardt on one level.
class Solver {
 public:
  Solver(const Level& level, const std::vector<double>& centres, const BrightnessPrior& prior, ThreadPool& pool)
      : level_(level), centres_(centres), prior_(prior), pool_(pool), points_(level.points()) {}

  /// Returns the energy.
  double minimize(JointState& state) {
    double lambda = 1e-2;
    ReducedSystem now = linearize(state, lambda, points_);
    std::vector<PointElimination> trial_points(points_.size());
    for (int i = 0; i < kIterations; ++i) {
      const Vector8 step = -damped(now.H, lambda).ldlt().solve(now.b);
      if (!step.allFinite()) break;
      const JointState trial = moved(state, step, lambda);
      const ReducedSystem next = linearize(trial, lambda, trial_points);
      if (!(next.energy < now.energy)) {
        lambda *= 10;
        if (lambda > 1e4) break;
        now = linearize(state, lambda, points_);
        continue;
      }
      const bool converged = now.energy - next.energy < 1e-4 * now.energy;
      state = trial;
      now = next;
      std::swap(points_, trial_points);
      lambda = std::max(1e-6, lambda * 0.2);
      if (converged) break;
    }
    return now.energy;
  }

  ReducedSystem linearize(const JointState& state, double lambda, std::vector<PointElimination>& points) const {
    const int count = level_.points();
    std::vector<ReducedSystem> partial(ThreadPool::chunk_count(count, kChunk));
    pool_.for_chunks(count, kChunk, [&](int chunk, int begin, int end) {
      for (int i = begin; i < end; ++i) points[i] = eliminate(i, state, lambda, partial[chunk]);
    });
    ReducedSystem sums;
    for (const ReducedSystem& part : partial) {
      sums.H += part.H;
      sums.b += part.b;
      sums.energy += part.energy;
    }
    sums.H(6, 6) += prior_.a;
    sums.H(7, 7) += prior_.b;
    sums.b[6] += prior_.a * state.a;
    sums.b[7] += prior_.b * state.b;
    sums.energy += prior_.a * state.a * state.a + prior_.b * state.b * state.b;
    return sums;
  }

 private:
  static Matrix8 damped(Matrix8 H, double lambda) {
    H.diagonal() *= 1 + lambda;
    H.diagonal().array() += 1e-6;
    return H;
  }

  PointElimination eliminate(int i, const JointState& state, double lambda, ReducedSystem& sums) const {
    const PointSystem system = level_.linearize(i, state);
    const double pull = pull_precision(i);
    const double off = state.idepth[i] - centres_[i];
    PointElimination point{(system.h_dd + pull) * (1 + lambda), system.b_d + pull * off, system.h_dx};
    sums.energy += system.energy + pull * off * off;
    sums.H.noalias() += system.h_xx - system.h_dx * system.h_dx.transpose() / point.h_dd;
    sums.b.noalias() += system.b_x - system.h_dx * (point.b_d / point.h_dd);
    return point;
  }

  double pull_precision(int i) const {
    const double spread = kPriorSpread * std::max(1e-3, centres_[i]);
    return kPriorNoise * kPriorNoise / (spread * spread);
  }

  JointState moved(const JointState& state, const Vector8& step, double) const {
    JointState result = state;
    const SO3d rotation = SO3d::exp(step.segment<3>(3));
    result.T_second_first = SE3d(rotation * state.T_second_first.rotation(),
                                 rotation * state.T_second_first.translation() + step.head<3>());
    result.a += step[6];
    result.b += step[7];
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double change = -(points_[i].b_d + points_[i].h_dx.dot(step)) / points_[i].h_dd;
      result.idepth[i] = std::max(0.0, state.idepth[i] + change);
    }
    return result;
  }

  const Level& level_;
  const std::vector<double>& centres_;
  const BrightnessPrior& prior_;
  ThreadPool& pool_;
  std::vector<PointElimination> points_;
};

/// The scale direction is free: the direction's covariance is that within the plane orthogonal to t.
double direction_stddev(const ReducedSystem& system, const SE3d& T, double noise) {
  const Eigen::Vector3d& t = T.translation();
  Eigen::Vector3d axis = std::abs(t.x()) > 0.6 * t.norm() ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  Eigen::Matrix<double, 8, 7> basis = Eigen::Matrix<double, 8, 7>::Zero();
  basis.col(0).head<3>() = t.cross(axis).normalized();
  basis.col(1).head<3>() = t.cross(basis.col(0).head<3>()).normalized();
  basis.bottomRightCorner<5, 5>().setIdentity();
  Eigen::Matrix<double, 7, 7> H = basis.transpose() * system.H * basis;
  H.diagonal().array() += 1e-6;
  const Eigen::Matrix2d covariance = noise * noise * H.inverse().topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1])) / t.norm();
}

void assess(const Level& level, const ReducedSystem& system, JointFit& fit) {
  std::vector<float> residuals;
  std::vector<PointSystem> systems;
  for (int i = 0; i < level.points(); ++i) systems.push_back(level.linearize(i, fit.state, &residuals));
  std::vector<double> magnitudes;
  magnitudes.reserve(residuals.size());
  for (const float r : residuals) magnitudes.push_back(std::abs(r));
  fit.noise = magnitudes.empty() ? 0 : std::max(1.0, 1.4826 * median(magnitudes));
  fit.direction_stddev = direction_stddev(system, fit.state.T_second_first, fit.noise);
  for (int i = 0; i < level.points(); ++i) {
    const double variance = fit.noise * fit.noise / std::max(1e-9, systems[i].h_dd);
    fit.points.push_back({systems[i].visible, systems[i].rms, variance, level.parallax(i, fit.state)});
  }
}

}  // namespace

JointAlignment::JointAlignment(const PreparedFrame& first, const std::vector<Eigen::Vector2d>& pixels,
                               const PinholeIntrinsics& camera, ThreadPool& pool)
    : first_(first), pixels_(pixels), camera_(camera), pool_(pool), neighbours_(pixels.size()) {
  pool_.for_chunks(static_cast<int>(pixels_.size()), kChunk, [&](int, int begin, int end) {
    std::vector<std::pair<double, int>> distances(pixels_.size());
    for (int i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < pixels_.size(); ++j) {
        distances[j] = {(pixels_[i] - pixels_[j]).squaredNorm(), static_cast<int>(j)};
      }
      const std::size_t count = std::min<std::size_t>(kNeighbours + 1, distances.size());
      std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count), distances.end());
      for (std::size_t k = 1; k < count; ++k) neighbours_[i].push_back(distances[k].second);
    }
  });
}

std::vector<double> JointAlignment::neighbour_medians(const std::vector<double>& values) const {
  std::vector<double> result(values.size());
  std::vector<double> known;
  for (std::size_t i = 0; i < values.size(); ++i) {
    known.clear();
    for (const int j : neighbours_[i]) {
      if (!std::isnan(values[j])) known.push_back(values[j]);
    }
    result[i] = median(known);
  }
  return result;
}

JointFit JointAlignment::align(const PreparedFrame& second, JointState start, const BrightnessPrior& prior,
                               int coarsest) const {
  JointFit fit;
  fit.state = std::move(start);
  const int top = std::min(coarsest, static_cast<int>(first_.pyramid.levels.size()) - 1);
  for (int l = top; l >= 0; --l) {
    const std::vector<double> centres = neighbour_medians(fit.state.idepth);
    Level level(first_, second, pixels_, camera_, l, pool_);
    level.set_outlier_limit(fit.state);
    Solver solver(level, centres, prior, pool_);
    fit.energy = solver.minimize(fit.state);
    if (l > 0) continue;
    std::vector<PointElimination> points(pixels_.size());
    assess(level, solver.linearize(fit.state, 0, points), fit);
  }
  return fit;
}

}  // namespace ldso
