#pragma once
// What each frame cost and how well it was tracked: charts over the frames, and the histogram of their times.

#include <string>
#include <vector>

#include "results/run_report.h"

namespace ldso {

/// Of one list of times.
struct TimeSummary {
  double median_ms = 0, mean_ms = 0, p95_ms = 0, p99_ms = 0, worst_ms = 0;
  double interval_ms = 0;  ///< The usual time between two frames of the sequence; 0 if unknown.
  double late_share = 0;   ///< Of the frames that took longer than the interval.
};

/// All zero if there is no frame.
TimeSummary summarize_times(const RunSummary& summary);

/// Strips of frame time, points, residual, brightness and exposure over the frames as one SVG; frames without a pose
/// are shaded, closed loops marked. Empty if there are fewer than two frames.
std::string frame_strips(const RunSummary& summary);

/// Frames over their time, those that became keyframes set apart. Empty if there is no frame.
std::string time_histogram(const RunSummary& summary);

}  // namespace ldso
