#include "odometry/depth/point_activator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "odometry/depth/point_refiner.h"
#include "odometry/depth/spacing_grid.h"

namespace ldso {
namespace {

/// Least spacing of active points: none, where points are rare [px].
constexpr float kLeastSpacing = 0.0f;
/// Largest spacing of active points: beyond it an image would hold too few of them [px].
constexpr float kMostSpacing = 12.0f;
/// Largest block scale of the selection: coarse points need that much more room.
constexpr float kMostScale = 4.0f;
/// Points that a thread takes at once.
constexpr int kActivatedAtOnce = 32;

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

int PointActivator::activate(Window& window) {
  steer_spacing(window);
  const FramePairs pairs(window);
  const std::vector<Candidate> candidates = choose(window, pairs);
  std::vector<std::optional<ActivePoint>> refined(candidates.size());
  pool_.for_chunks(static_cast<int>(candidates.size()), kActivatedAtOnce, [&](int, int begin, int end) {
    PointRefiner refiner(window, pairs, tracing_.least_idepth_hessian);
    for (int i = begin; i < end; ++i) refined[i] = refiner.refine(*candidates[i].immature, *candidates[i].host);
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
