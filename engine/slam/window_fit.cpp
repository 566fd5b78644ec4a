#include "slam/window_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/pinhole_projection.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Stretches of the sequence whose differences are taken as independent.
constexpr std::size_t kStretches = 8;
/// Windows in each of them, at least.
constexpr std::size_t kLeastInStretch = 2;
/// Least improvement of the residuals. Runs over the same frames with calibrations that are equally good differ by
/// less.
constexpr double kLeastImprovement = 0.004;
/// The same for an improvement that is certain only because each stretch has it.
constexpr double kLeastEverywhere = 0.01;
/// In standard deviations; few stretches show theirs only roughly.
constexpr double kSignificance = 3;

/// Pixels from the edge of the image within which a pattern is not whole.
constexpr double kBorder = 4;

/// Difference of `after` from what `before` was at the same frame, between its windows linearly.
WindowFit difference(const std::vector<WindowFit>& before, const WindowFit& after) {
  const auto next = std::lower_bound(before.begin(), before.end(), after.frame_id,
                                     [](const WindowFit& fit, std::int64_t id) { return fit.frame_id < id; });
  const WindowFit& b = *next;
  const WindowFit& a = next == before.begin() ? b : *(next - 1);
  const auto length = static_cast<double>(b.frame_id - a.frame_id);
  const double share = length > 0 ? static_cast<double>(after.frame_id - a.frame_id) / length : 1;
  return {after.frame_id, after.log_rmse - (1 - share) * a.log_rmse - share * b.log_rmse,
          after.log_inlier_share - (1 - share) * a.log_inlier_share - share * b.log_inlier_share};
}

std::vector<WindowFit> differences(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after) {
  std::vector<WindowFit> result;
  if (before.empty()) return result;
  for (const WindowFit& fit : after) {
    const bool both = fit.frame_id >= before.front().frame_id && fit.frame_id <= before.back().frame_id;
    if (both) result.push_back(difference(before, fit));
  }
  return result;
}

/// Whether a pixel of a host lies, with its depth, in front of the target and in its image.
bool is_in_view(const Window& window, const SE3d& T_target_host, const ActivePoint& point) {
  const PinholeIntrinsics camera = window.intrinsics();
  const Eigen::Vector3d ray = viewing_ray(camera, {point.u, point.v});
  const Eigen::Vector3d x = T_target_host.rotation() * ray + point.idepth * T_target_host.translation();
  if (!(x.z() > 0)) return false;
  const Eigen::Vector2d pixel = project(camera, x);
  return pixel.minCoeff() >= kBorder && pixel.x() < window.width - kBorder && pixel.y() < window.height - kBorder;
}

}  // namespace

WindowFit fit_of(const Window& window) {
  const Keyframe& newest = *window.keyframes.back();
  std::size_t in_view = 0, inliers = 0;
  for (const auto& host : window.keyframes) {
    if (host.get() == &newest) continue;
    const SE3d T_newest_host = newest.state.T_c_w() * host->state.T_c_w().inverse();
    for (const ActivePoint& point : host->points) {
      if (!is_in_view(window, T_newest_host, point)) continue;
      ++in_view;
      inliers += std::any_of(point.residuals.begin(), point.residuals.end(),
                             [&](const PointResidual& residual) { return residual.target == &newest; });
    }
  }
  const double share = in_view > 0 ? static_cast<double>(inliers) / static_cast<double>(in_view) : 0;
  return {window.keyframes.back()->id(), std::log(std::max(kLeastResidualRmse, window.rmse)),
          std::log(std::max(1e-3, share))};
}

std::optional<WindowFit> mean_difference(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after,
                                         std::size_t least) {
  const std::vector<WindowFit> changes = differences(before, after);
  if (changes.empty() || changes.size() < least) return std::nullopt;
  WindowFit mean{changes.back().frame_id, 0, 0};
  for (const WindowFit& change : changes) {
    mean.log_rmse += change.log_rmse / static_cast<double>(changes.size());
    mean.log_inlier_share += change.log_inlier_share / static_cast<double>(changes.size());
  }
  return mean;
}

FitChange compare_fits(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after) {
  const std::vector<WindowFit> changes = differences(before, after);
  FitChange result;
  if (changes.size() < kStretches * kLeastInStretch) return result;
  result.worst = -std::numeric_limits<double>::infinity();
  double squares = 0;
  std::vector<double> residuals;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const std::size_t begin = k * changes.size() / kStretches, end = (k + 1) * changes.size() / kStretches;
    double residual = 0;
    for (std::size_t i = begin; i < end; ++i) {
      residual += changes[i].log_rmse / static_cast<double>(end - begin);
      result.inlier_share += changes[i].log_inlier_share / static_cast<double>((end - begin) * kStretches);
    }
    result.residual += residual / kStretches;
    result.worst = std::max(result.worst, residual);
    squares += residual * residual;
    residuals.push_back(residual);
  }
  result.median = upper_median(residuals);
  const double variance = (squares - kStretches * result.residual * result.residual) / (kStretches - 1);
  result.stddev = std::sqrt(std::max(0.0, variance) / kStretches);
  result.is_known = true;
  return result;
}

bool is_better(const FitChange& change) {
  const double explained = kShrinkByLoss * std::max(0.0, -change.inlier_share);
  if (!change.is_known) return false;
  const bool is_certain = change.residual < -std::max(kLeastImprovement, kSignificance * change.stddev) - explained;
  const bool is_everywhere = change.worst < -explained && change.residual < -kLeastEverywhere - explained;
  return is_certain || is_everywhere;
}

}  // namespace ldso
