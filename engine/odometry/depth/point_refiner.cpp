#include "odometry/depth/point_refiner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ldso {
namespace {

/// Steps of Levenberg-Marquardt: the interval of tracing is narrow.
constexpr int kRefinerSteps = 3;
/// Damping of Levenberg-Marquardt at first.
constexpr float kFirstRefinerLambda = 0.1f;
/// A step below this share of the inverse depth changes no pixel.
constexpr float kSmallStep = 1e-4f;

}  // namespace

void PointRefiner::set_targets(const ImmaturePoint& immature, const Keyframe& host) {
  host_ = &host;
  targets_.clear();
  jobs_.clear();
  for (int t = 0; t < window_.size(); ++t) {
    if (t == host.index) continue;
    targets_.push_back(t);
    jobs_.push_back({&immature.patch, &pairs_(host.index, t).warp, immature.u, immature.v, 0});
  }
  sums_.resize(targets_.size());
  best_sums_.resize(targets_.size());
}

float PointRefiner::outlier_energy(std::size_t target) const {
  return std::max(host_->outlier_energy, window_.keyframes[targets_[target]]->outlier_energy);
}

PointRefiner::Quadratic PointRefiner::evaluate(float idepth, std::vector<PatternSums>& sums) {
  for (PatternJob& job : jobs_) job.idepth = idepth;
  evaluate_patterns(jobs_.data(), sums.data(), static_cast<int>(jobs_.size()));
  Quadratic result;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const PatternSums& s = sums[i];
    const float limit = outlier_energy(i);
    ProjectionJacobian J;
    const FramePair& pair = pairs_(host_->index, targets_[i]);
    if (!s.in_view || s.energy > limit || !projection_jacobian(pair, jobs_[i].u, jobs_[i].v, idepth, J)) {
      result.energy += limit;
      continue;
    }
    result.energy += s.energy;
    result.H += s.gxx * J.idepth.x() * J.idepth.x() + 2 * s.gxy * J.idepth.x() * J.idepth.y() +
                s.gyy * J.idepth.y() * J.idepth.y();
    result.b += s.rgx * J.idepth.x() + s.rgy * J.idepth.y();
  }
  return result;
}

std::optional<ActivePoint> PointRefiner::refine(const ImmaturePoint& immature, const Keyframe& host) {
  set_targets(immature, host);
  float idepth = 0.5f * (immature.idepth_min + immature.idepth_max), lambda = kFirstRefinerLambda;
  Quadratic best = evaluate(idepth, best_sums_);
  for (int i = 0; i < kRefinerSteps; ++i) {
    if (!(best.H * (1 + lambda) > 0)) break;
    const float step = -best.b / (best.H * (1 + lambda));
    const Quadratic tried = evaluate(idepth + step, sums_);
    if (tried.energy < best.energy) {
      idepth += step;
      best = tried;
      std::swap(best_sums_, sums_);
      lambda *= 0.5f;
    } else {
      lambda *= 5;
    }
    if (std::abs(step) < kSmallStep * std::abs(idepth)) break;
  }
  if (!std::isfinite(idepth) || !(idepth > 0) || best.H < least_idepth_hessian_) return std::nullopt;
  ActivePoint point;
  point.u = immature.u;
  point.v = immature.v;
  point.idepth = idepth;
  point.idepth_hessian = best.H;
  point.density_scale = immature.density_scale;
  point.is_corner = immature.is_corner;
  point.patch = immature.patch;
  add_residuals(point);
  if (point.residuals.empty()) return std::nullopt;
  return point;
}

void PointRefiner::add_residuals(ActivePoint& point) const {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const PatternSums& sums = best_sums_[i];
    const bool inlier = sums.in_view && sums.energy <= outlier_energy(i);
    const int age = window_.size() - 1 - targets_[i];
    if (age < 2) {
      point.newest_states[age] =
          inlier ? ResidualState::kInlier : (sums.in_view ? ResidualState::kOutlier : ResidualState::kOutOfView);
    }
    if (!inlier) continue;
    PointResidual residual;
    residual.target = window_.keyframes[targets_[i]].get();
    point.residuals.push_back(residual);
  }
}

}  // namespace ldso
