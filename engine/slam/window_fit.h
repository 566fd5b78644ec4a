#pragma once

// How well the windows of a run explain their images, and whether those of another run over the same frames do it
// better: the proof of a calibration.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "odometry/state/window.h"

namespace ldso {

/// A fit is not better because what does not fit was left out: by so much the rest shrinks with the share that is.
inline constexpr double kShrinkByLoss = 1.5;

/// One window after its optimization.
struct WindowFit {
  std::int64_t frame_id = 0;    ///< Of its newest keyframe.
  double log_rmse = 0;          ///< Of the inlier residuals.
  double log_inlier_share = 0;  ///< Of the older keyframes' points that it has in view: those with an inlier residual.
};

WindowFit fit_of(const Window& window);

/// Of one run against another, over the frames that both have; logarithms of ratios.
struct FitChange {
  bool is_known = false;    ///< There were enough windows.
  double residual = 0;      ///< Of the root mean squared residuals: negative if they have become smaller. The mean.
  double median = 0;        ///< The same of the middle one of its stretches: a single one may differ by chance.
  double stddev = 0;        ///< Of that mean, from how it varies along the sequence.
  double worst = 0;         ///< The largest of its stretches: negative if the residuals have become smaller in each.
  double inlier_share = 0;  ///< Of the inliers' share: negative if fewer are left.
};

/// The mean over the windows of `after` between the frames of `before`, at their frames; nothing if they are fewer than
/// `least`. Both in the order of their frames.
std::optional<WindowFit> mean_difference(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after,
                                         std::size_t least);

/// Both in the order of their frames.
FitChange compare_fits(const std::vector<WindowFit>& before, const std::vector<WindowFit>& after);

/// Whether the change is an improvement by a margin and for certain: by its standard deviation, or because there is no
/// stretch of the sequence without it (how much a stretch gains depends on its motion, and its scatter is no noise).
bool is_better(const FitChange& change);

}  // namespace ldso
