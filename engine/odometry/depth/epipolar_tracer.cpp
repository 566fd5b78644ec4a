#include "odometry/depth/epipolar_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/interpolation.h"
#include "odometry/depth/search_kernels.h"
#include "odometry/state/robust_weight.h"

namespace ldso {
namespace {

/// Positions along a segment that are looked at, one pixel apart.
constexpr int kMostPositions = 100;
/// Farthest that a turned pattern may reach from its centre [px].
constexpr float kPatternReach = 3.5f;
/// Searched segments stay that far inside the image: the last position may lie one pixel beyond their end.
constexpr float kBorder = kPatternReach + 2.5f;
/// Intervals shorter than this need no search [px].
constexpr float kShortInterval = 1.5f;
/// Second-best matches nearer than this to the best one do not count [px].
constexpr float kAmbiguityRadius = 2;
/// Energy of a match whose pixels differ by 12 grey levels each: above it is an outlier (DSO's threshold of a
/// residual).
constexpr float kOutlierEnergy = 12.0f * 12.0f * kPatternSize;
/// Slack on the outlier energy of tracing over that of the window.
constexpr float kOutlierSlack = 1.2f;
/// Gauss-Newton steps below a pixel.
constexpr int kRefinements = 4;
/// A match is believed to be that wrong at most [px].
constexpr float kLargestError = 10;
/// Error of a match that a wrong epipolar line causes [px].
constexpr float kLineError = 0.2f;
/// Error of a match that the image causes where its gradient lies along the line; it grows as the gradient turns away
/// [px].
constexpr float kImageError = 0.2f;
/// Where the near end of an unbounded search is projected from, to know the line's direction [1 / map unit].
constexpr float kNearIdepth = 0.01f;
/// Energy above that of any match.
constexpr float kNoMatchEnergy = 1e10f;
/// Energy that a pixel adds which may not be used: above that of any grey levels under the robust weight.
constexpr float kInvalidEnergy = 1e4f;
/// After more positions the quality is that of a real search, not of a remainder.
constexpr int kManyPositions = 10;
/// A refinement by less than this is the last one [px].
constexpr float kSmallRefinement = 0.03f;

}  // namespace

/// The piece of the epipolar line that is searched.
struct EpipolarTracer::Segment {
  float far_x = 0, far_y = 0;  ///< Projection at the smallest inverse depth.
  float dx = 0, dy = 0;        ///< Unit direction towards larger inverse depths.
  float length = 0;            ///< [px]
  float error = 0;             ///< Expected error of a match along the line [px].
  PatternSearch pattern;
};

struct EpipolarTracer::Match {
  float x = 0, y = 0;
  float energy = kNoMatchEnergy;
};

bool make_immature_point(const Image<Texel>& image, float u, float v, ImmaturePoint& point) {
  point = {};
  point.u = u;
  point.v = v;
  point.idepth_max = std::numeric_limits<float>::quiet_NaN();
  point.energy_threshold = kOutlierEnergy;
  for (int i = 0; i < kPatternSize; ++i) {
    const float x = u + static_cast<float>(kPattern[i].dx), y = v + static_cast<float>(kPattern[i].dy);
    if (x < 1 || y < 1 || x >= static_cast<float>(image.width()) - 2 || y >= static_cast<float>(image.height()) - 2)
      return false;
    const Texel t = quadratic(image.view(), x, y);
    if (!(t.valid > kAllValid) || !std::isfinite(t.intensity)) return false;
    const float gradient2 = t.dx * t.dx + t.dy * t.dy;
    constexpr float c2 = kGradientWeight * kGradientWeight;
    point.patch.intensity[i] = t.intensity;
    point.patch.weight[i] = std::sqrt(c2 / (c2 + gradient2));
    point.gxx += t.dx * t.dx;
    point.gxy += t.dx * t.dy;
    point.gyy += t.dy * t.dy;
  }
  return true;
}

bool EpipolarTracer::find_segment(const ImmaturePoint& point, const PatternWarp& warp, Segment& segment,
                                  TraceStatus& status) const {
  const float* K = warp.KRKi;
  const float px = K[0] * point.u + K[1] * point.v + K[2];
  const float py = K[3] * point.u + K[4] * point.v + K[5];
  const float pz = K[6] * point.u + K[7] * point.v + K[8];
  const auto project = [&](float idepth, float& x, float& y) {
    const float z = pz + warp.Kt[2] * idepth;
    x = (px + warp.Kt[0] * idepth) / z;
    y = (py + warp.Kt[1] * idepth) / z;
    return z > 1e-3f;
  };
  const float max_x = static_cast<float>(warp.width) - kBorder - 1,
              max_y = static_cast<float>(warp.height) - kBorder - 1;
  const auto inside = [&](float x, float y) { return x > kBorder && y > kBorder && x < max_x && y < max_y; };
  status = TraceStatus::kOutOfView;
  if (!project(point.idepth_min, segment.far_x, segment.far_y) || !inside(segment.far_x, segment.far_y)) return false;
  float near_x = 0, near_y = 0;
  const bool bounded = std::isfinite(point.idepth_max);
  if (!project(bounded ? point.idepth_max : kNearIdepth, near_x, near_y)) return false;
  segment.dx = near_x - segment.far_x;
  segment.dy = near_y - segment.far_y;
  segment.length = std::hypot(segment.dx, segment.dy);
  if (bounded && !inside(near_x, near_y)) return false;
  status = TraceStatus::kSkipped;
  if ((bounded && segment.length < kShortInterval) || !(segment.length > 1e-6f)) return false;
  segment.dx /= segment.length;
  segment.dy /= segment.length;
  if (!bounded || segment.length > longest_search_) segment.length = longest_search_;
  // An unbounded search ends at the image's border.
  while (segment.length > 1 &&
         !inside(segment.far_x + segment.length * segment.dx, segment.far_y + segment.length * segment.dy)) {
    segment.length -= 1;
  }
  const float along = segment.dx * (point.gxx * segment.dx + point.gxy * segment.dy) +
                      segment.dy * (point.gxy * segment.dx + point.gyy * segment.dy);
  const float across = segment.dy * (point.gxx * segment.dy - point.gxy * segment.dx) -
                       segment.dx * (point.gxy * segment.dy - point.gyy * segment.dx);
  segment.error = std::min(kLargestError, kLineError + kImageError * (along + across) / std::max(along, 1e-6f));
  status = TraceStatus::kBadlyConditioned;
  return !(bounded && 2 * segment.error > segment.length);
}

EpipolarTracer::Match EpipolarTracer::search(ImmaturePoint& point, const Segment& segment) {
  const int count = std::min(kMostPositions, static_cast<int>(1.9999f + segment.length));
  PatternSearch pattern = segment.pattern;
  pattern.x = segment.far_x;
  pattern.y = segment.far_y;
  pattern.step_x = segment.dx;
  pattern.step_y = segment.dy;
  std::array<float, kMostPositions> energies;
  search_energies(pattern, count, energies.data());
  const int best = static_cast<int>(std::min_element(energies.begin(), energies.begin() + count) - energies.begin());
  float second = kNoMatchEnergy;
  for (int i = 0; i < count; ++i) {
    if (std::abs(i - best) > static_cast<int>(kAmbiguityRadius)) second = std::min(second, energies[i]);
  }
  const float quality = second / std::max(energies[best], 1e-3f);
  if (quality < point.quality || count > kManyPositions) point.quality = quality;
  const auto step = static_cast<float>(best);
  return {segment.far_x + step * segment.dx, segment.far_y + step * segment.dy, energies[best]};
}

void EpipolarTracer::refine(const PatternWarp& warp, const Segment& segment, Match& match) {
  const PatternSearch& pattern = segment.pattern;
  const ImageView<const Texel> image{warp.texels, warp.width, warp.height, warp.width};
  Match current = match;
  match.energy = std::numeric_limits<float>::infinity();
  float last_step = 0, gain = 1;
  for (int iteration = 0; iteration < kRefinements; ++iteration) {
    if (!is_interpolable(image, current.x, current.y, kPatternReach)) break;
    float H = 1, b = 0, energy = 0;
    for (int i = 0; i < kPatternSize; ++i) {
      const float x = current.x + pattern.offset_x[i], y = current.y + pattern.offset_y[i];
      const Texel t = quadratic(image, x, y);
      if (!(t.valid > kAllValid)) {
        energy += kInvalidEnergy;
        continue;
      }
      const float r = t.intensity - pattern.intensity[i];
      const float weight = huber_weight(r);
      const float slope = segment.dx * t.dx + segment.dy * t.dy;
      H += weight * slope * slope;
      b += weight * r * slope;
      energy += weight * r * r * (2 - weight);
    }
    if (energy > match.energy) {
      // Worse: go half of the way back.
      gain *= 0.5f;
      last_step *= 0.5f;
      current.x = match.x + last_step * segment.dx;
      current.y = match.y + last_step * segment.dy;
    } else {
      match = {current.x, current.y, energy};
      last_step = std::clamp(-gain * b / H, -1.0f, 1.0f);
      current.x = match.x + last_step * segment.dx;
      current.y = match.y + last_step * segment.dy;
    }
    if (std::fabs(last_step) < kSmallRefinement) break;
  }
}

TraceStatus EpipolarTracer::trace(ImmaturePoint& point, const PatternWarp& pair) const {
  if (point.status == TraceStatus::kOutOfView) return point.status;
  PatternWarp warp = pair;
  // With a rolling shutter the line is that of the row which shows the middle of the interval.
  const float idepth = std::isfinite(point.idepth_max) ? 0.5f * (point.idepth_min + point.idepth_max) : 0.0f;
  static_cast<PixelWarp&>(warp) = warp_at(pair, point.u, point.v, idepth);
  Segment segment;
  if (!find_segment(point, warp, segment, point.status)) return point.status;
  // The plane of the pattern turns with the view.
  for (int i = 0; i < kPatternSize; ++i) {
    const auto dx = static_cast<float>(kPattern[i].dx), dy = static_cast<float>(kPattern[i].dy);
    segment.pattern.offset_x[i] = warp.KRKi[0] * dx + warp.KRKi[1] * dy;
    segment.pattern.offset_y[i] = warp.KRKi[3] * dx + warp.KRKi[4] * dy;
    segment.pattern.intensity[i] = warp.factor * point.patch.intensity[i] + warp.offset;
    // A view that turned so far that the pattern leaves its margin cannot be compared pixel by pixel.
    if (!(std::fabs(segment.pattern.offset_x[i]) <= kPatternReach &&
          std::fabs(segment.pattern.offset_y[i]) <= kPatternReach)) {
      return point.status = TraceStatus::kOutOfView;
    }
  }
  segment.pattern.texels = warp.texels;
  segment.pattern.width = warp.width;
  Match match = search(point, segment);
  const Match coarse = match;
  refine(warp, segment, match);
  const bool left = std::hypot(match.x - coarse.x, match.y - coarse.y) > 2;
  if (!(match.energy < point.energy_threshold * kOutlierSlack) || left) {
    // The next frame may find it again; one that the next keyframe finds like this is removed there.
    return point.status = TraceStatus::kOutlier;
  }
  const float* K = warp.KRKi;
  const float px = K[0] * point.u + K[1] * point.v + K[2];
  const float py = K[3] * point.u + K[4] * point.v + K[5];
  const float pz = K[6] * point.u + K[7] * point.v + K[8];
  const bool by_x = segment.dx * segment.dx > segment.dy * segment.dy;
  const auto idepth_at = [&](float shift) {
    const float x = match.x + shift * segment.dx, y = match.y + shift * segment.dy;
    return by_x ? (pz * x - px) / (warp.Kt[0] - warp.Kt[2] * x) : (pz * y - py) / (warp.Kt[1] - warp.Kt[2] * y);
  };
  float low = idepth_at(-segment.error), high = idepth_at(segment.error);
  if (low > high) std::swap(low, high);
  if (!std::isfinite(low) || !std::isfinite(high) || high < 0) return point.status = TraceStatus::kOutlier;
  point.idepth_min = std::max(0.0f, low);
  point.idepth_max = high;
  point.interval_px = 2 * segment.error;
  return point.status = TraceStatus::kGood;
}

}  // namespace ldso
