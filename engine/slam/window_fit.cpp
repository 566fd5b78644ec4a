#include "slam/window_fit.h"

#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

/// Stretches of the sequence whose differences are taken as independent.
constexpr std::size_t kStretches = 6;
/// Windows in each of them, at least.
constexpr std::size_t kLeastInStretch = 2;
/// Least improvement of the residuals. Runs over the same frames with calibrations that are equally good differ by
/// less.
constexpr double kLeastImprovement = 0.004;
/// In standard deviations; few stretches show theirs only roughly.
constexpr double kSignificance = 3;
/// A fit is not better because what does not fit was left out: by so much the rest shrinks with the share that is.
constexpr double kShrinkByLoss = 1.5;

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

}  // namespace

WindowFit fit_of(const Window& window) {
  std::size_t points = 0, residuals = 0;
  for (const auto& keyframe : window.keyframes) {
    points += keyframe->points.size();
    for (const ActivePoint& point : keyframe->points) residuals += point.residuals.size();
  }
  const double possible = static_cast<double>(points) * std::max(1, window.size() - 1);
  const double share = points > 0 ? static_cast<double>(residuals) / possible : 0;
  return {window.keyframes.back()->id(), std::log(std::max(kLeastResidualRmse, window.rmse)),
          std::log(std::max(1e-3, share))};
}

FitChange compare_fits(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after) {
  const std::vector<WindowFit> changes = differences(before, after);
  FitChange result;
  if (changes.size() < kStretches * kLeastInStretch) return result;
  double squares = 0;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const std::size_t begin = k * changes.size() / kStretches, end = (k + 1) * changes.size() / kStretches;
    double residual = 0;
    for (std::size_t i = begin; i < end; ++i) {
      residual += changes[i].log_rmse / static_cast<double>(end - begin);
      result.inlier_share += changes[i].log_inlier_share / static_cast<double>((end - begin) * kStretches);
    }
    result.residual += residual / kStretches;
    squares += residual * residual;
  }
  const double variance = (squares - kStretches * result.residual * result.residual) / (kStretches - 1);
  result.stddev = std::sqrt(std::max(0.0, variance) / kStretches);
  result.is_known = true;
  return result;
}

bool is_better(const FitChange& change) {
  const double explained = kShrinkByLoss * std::max(0.0, -change.inlier_share);
  return change.is_known && change.residual < -std::max(kLeastImprovement, kSignificance * change.stddev) - explained;
}

}  // namespace ldso
