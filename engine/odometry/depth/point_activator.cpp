#include "odometry/depth/point_activator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "odometry/depth/spacing_grid.h"

namespace ldso {
namespace {

constexpr float kLeastSpacing = 0.0f;
constexpr float kMostSpacing = 12.0f;
/// Largest block scale of the selection: coarse points need that much more room.
constexpr float kMostScale = 4.0f;
constexpr int kRefinements = 3;
constexpr std::size_t kMostTargets = 32;

/// Pixel of the newest keyframe where a point of the host lies; false outside of the image.
bool project(const PatternWarp& warp, float u, float v, float idepth, float& x, float& y) {
  const float* K = warp.KRKi;
  const float z = K[6] * u + K[7] * v + K[8] + warp.Kt[2] * idepth;
  x = (K[0] * u + K[1] * v + K[2] + warp.Kt[0] * idepth) / z;
  y = (K[3] * u + K[4] * v + K[5] + warp.Kt[1] * idepth) / z;
  return z > 0 && x > 2 && y > 2 && x < static_cast<float>(warp.width) - 3 && y < static_cast<float>(warp.height) - 3;
}

/// Whether tracing has determined the point well enough.
bool is_ready(const ImmaturePoint& point, const TracingSettings& settings) {
  const bool traced = point.status == TraceStatus::kGood || point.status == TraceStatus::kSkipped ||
                      point.status == TraceStatus::kBadlyConditioned || point.status == TraceStatus::kOutOfView;
  return traced && std::isfinite(point.idepth_max) && point.interval_px < settings.largest_interval &&
         point.quality > settings.least_quality && point.idepth_min + point.idepth_max > 0;
}

}  // namespace

struct PointActivator::Candidate {
  ImmaturePoint* immature;
  const Keyframe* host;
};

void PointActivator::steer_spacing(const Window& window) {
  int active = 0;
  for (const auto& keyframe : window.keyframes) active += static_cast<int>(keyframe->points.size());
  const double ratio = static_cast<double>(active) / wanted_;
  // Proportional steering on the logarithm, at most a third a keyframe.
  const double factor = std::clamp(std::pow(ratio, 0.5), 0.67, 1.5);
  spacing_ = std::clamp(static_cast<float>(std::max(0.5f, spacing_) * factor), kLeastSpacing, kMostSpacing);
}

std::vector<PointActivator::Candidate> PointActivator::choose(Window& window, const FramePairs& pairs) {
  const int newest = window.size() - 1;
  SpacingGrid grid(window.width, window.height, spacing_ * kMostScale);
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      float x = point.u, y = point.v;
      if (host->index != newest && !project(pairs(host->index, newest).warp, point.u, point.v, point.idepth, x, y))
        continue;
      grid.add(x, y);
    }
  }
  std::vector<Candidate> chosen;
  for (int h = 0; h < newest; ++h) {
    Keyframe& host = *window.keyframes[h];
    for (ImmaturePoint& point : host.immature) {
      const bool never = point.status == TraceStatus::kOutlier || !std::isfinite(point.idepth_max);
      const bool gone = point.status == TraceStatus::kOutOfView || host.leaving;
      if (!is_ready(point, tracing_)) {
        point.flagged = gone || (never && point.status == TraceStatus::kOutlier);
        continue;
      }
      float x = 0, y = 0;
      if (!project(pairs(h, newest).warp, point.u, point.v, 0.5f * (point.idepth_min + point.idepth_max), x, y)) {
        point.flagged = true;
        continue;
      }
      if (!grid.has_room(x, y, spacing_ * point.density_scale)) {
        point.flagged = gone;
        continue;
      }
      grid.add(x, y);
      chosen.push_back({&point, &host});
    }
  }
  return chosen;
}

std::optional<ActivePoint> PointActivator::refine(const ImmaturePoint& immature, const Keyframe& host,
                                                  const Window& window, const FramePairs& pairs) const {
  std::array<PatternJob, kMostTargets> jobs;
  std::array<PatternSums, kMostTargets> sums, best_sums;
  std::array<int, kMostTargets> targets{};
  int count = 0;
  for (int t = 0; t < window.size() && count < static_cast<int>(kMostTargets); ++t) {
    if (t == host.index) continue;
    targets[count] = t;
    jobs[count++] = {&immature.patch, &pairs(host.index, t).warp, immature.u, immature.v, 0};
  }
  const auto evaluate = [&](float idepth, std::array<PatternSums, kMostTargets>& out, float& H, float& b) {
    for (int i = 0; i < count; ++i) jobs[i].idepth = idepth;
    evaluate_patterns(jobs.data(), out.data(), count);
    float energy = 0;
    H = b = 0;
    for (int i = 0; i < count; ++i) {
      const PatternSums& s = out[i];
      const float limit = std::max(host.outlier_energy, window.keyframes[targets[i]]->outlier_energy);
      ProjectionJacobian J;
      const FramePair& pair = pairs(host.index, targets[i]);
      if (!s.in_view || s.energy > limit || !projection_jacobian(pair, immature.u, immature.v, idepth, J)) {
        energy += limit;
        continue;
      }
      energy += s.energy;
      H += s.gxx * J.idepth.x() * J.idepth.x() + 2 * s.gxy * J.idepth.x() * J.idepth.y() +
           s.gyy * J.idepth.y() * J.idepth.y();
      b += s.rgx * J.idepth.x() + s.rgy * J.idepth.y();
    }
    return energy;
  };
  float idepth = 0.5f * (immature.idepth_min + immature.idepth_max);
  float H = 0, b = 0, lambda = 0.1f;
  float energy = evaluate(idepth, best_sums, H, b);
  for (int i = 0; i < kRefinements; ++i) {
    if (!(H * (1 + lambda) > 0)) break;
    const float step = -b / (H * (1 + lambda));
    float H_new = 0, b_new = 0;
    const float energy_new = evaluate(idepth + step, sums, H_new, b_new);
    if (energy_new < energy) {
      idepth += step;
      H = H_new;
      b = b_new;
      energy = energy_new;
      best_sums = sums;
      lambda *= 0.5f;
    } else {
      lambda *= 5;
    }
    if (std::abs(step) < 1e-4f * std::abs(idepth)) break;
  }
  if (!std::isfinite(idepth) || !(idepth > 0) || H < tracing_.least_idepth_hessian) return std::nullopt;
  ActivePoint point;
  point.u = immature.u;
  point.v = immature.v;
  point.idepth = idepth;
  point.idepth_hessian = H;
  point.density_scale = immature.density_scale;
  point.is_corner = immature.is_corner;
  point.patch = immature.patch;
  for (int i = 0; i < count; ++i) {
    Keyframe* target = window.keyframes[targets[i]].get();
    const float limit = std::max(host.outlier_energy, target->outlier_energy);
    const bool inlier = best_sums[i].in_view && best_sums[i].energy <= limit;
    const int age = window.size() - 1 - targets[i];
    if (age < 2) {
      point.newest_states[age] = inlier ? ResidualState::kInlier
                                        : (best_sums[i].in_view ? ResidualState::kOutlier : ResidualState::kOutOfView);
    }
    if (!inlier) continue;
    PointResidual residual;
    residual.target = target;
    point.residuals.push_back(residual);
  }
  if (point.residuals.empty()) return std::nullopt;
  return point;
}

int PointActivator::activate(Window& window) {
  steer_spacing(window);
  const FramePairs pairs(window);
  const std::vector<Candidate> candidates = choose(window, pairs);
  std::vector<std::optional<ActivePoint>> refined(candidates.size());
  pool_.for_chunks(static_cast<int>(candidates.size()), 32, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) refined[i] = refine(*candidates[i].immature, *candidates[i].host, window, pairs);
  });
  int activated = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Keyframe& host = *window.keyframes[candidates[i].host->index];
    candidates[i].immature->flagged = true;
    if (refined[i]) {
      host.points.push_back(std::move(*refined[i]));
      ++activated;
    } else {
      ++host.dropped;
    }
  }
  for (auto& keyframe : window.keyframes) {
    std::erase_if(keyframe->immature, [](const ImmaturePoint& point) { return point.flagged; });
  }
  return activated;
}

}  // namespace ldso
