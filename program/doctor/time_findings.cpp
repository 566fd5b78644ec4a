#include "doctor/time_findings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

/// A step of so many usual ones lacks at least one frame.
constexpr double kGap = 1.75;

/// A step of so many is one in which the camera has gone somewhere else [s].
constexpr double kLongGap = 0.5;

/// Share of frames that may be missing here and there: a camera drops one now and then.
constexpr double kMissingShare = 0.02;

/// Frames a second that a hand-held camera needs at least.
constexpr double kLowestRate = 5;

struct Gaps {
  int count = 0;
  double missing = 0;  ///< Frames.
  double longest = 0;  ///< [s]
  std::size_t where = 0;
};

Gaps find_gaps(const std::vector<double>& steps, double usual) {
  Gaps gaps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] <= kGap * usual) continue;
    ++gaps.count;
    gaps.missing += std::round(steps[i] / usual) - 1;
    if (steps[i] <= gaps.longest) continue;
    gaps.longest = steps[i];
    gaps.where = i;
  }
  return gaps;
}

void add_gaps(const std::vector<double>& steps, double usual, Findings& findings) {
  const Gaps gaps = find_gaps(steps, usual);
  if (gaps.count == 0) return;
  const double share = gaps.missing / (gaps.missing + static_cast<double>(steps.size()));
  const bool matters = gaps.longest > kLongGap || share > kMissingShare;
  findings.push_back(
      {"times.gaps", matters ? Severity::kWarning : Severity::kNote, 60 + 100 * share,
       format_text("frames are missing at %d places, %.0f in all (%.1f %%); the longest gap is %.2f s, after frame %zu",
                   gaps.count, gaps.missing, 100 * share, gaps.longest, gaps.where),
       matters
           ? "record to a faster disk or with fewer pixels; run the parts before and after a long gap by themselves "
             "(--start, --end)"
           : "nothing, if tracking goes on behind them"});
}

}  // namespace

Findings time_findings(const std::vector<double>& times) {
  Findings findings;
  if (times.size() < 3) return findings;
  const double sign = times.back() < times.front() ? -1 : 1;
  std::vector<double> steps;
  std::size_t disordered = 0, first = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = sign * (times[i] - times[i - 1]);
    if (step > 0) {
      steps.push_back(step);
    } else if (disordered++ == 0) {
      first = i;
    }
  }
  if (disordered > 0) {
    findings.push_back(
        {"times.order", Severity::kWarning, 90,
         format_text("%zu frames are not later than the one before them, first frame %zu", disordered, first),
         "sort the images and their times; frames with the same time are copies, remove them"});
  }
  if (steps.size() < 2) return findings;
  const double usual = median_of(steps);
  if (disordered == 0) add_gaps(steps, usual, findings);
  if (1 / usual < kLowestRate) {
    findings.push_back({"times.rate", Severity::kWarning, 50,
                        format_text("there are only %.2f frames a second", 1 / usual),
                        "record at 20 to 60 frames a second; if the times are wrong, correct times.txt or give --fps"});
  }
  return findings;
}

}  // namespace ldso
