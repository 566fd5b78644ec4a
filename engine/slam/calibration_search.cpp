#include "slam/calibration_search.h"

#include <cmath>
#include <utility>

#include "util/format_text.h"

namespace ldso {
namespace {

/// A calibration that is being tried has to stay where it is but for so many standard deviations.
constexpr double kTriedSignificance = 3;
/// From the third on, a change of the calibration by more than this factor times the one before is a flight. Each may
/// be somewhat larger than the last: what is not determined in bent images may be so once they are straighter.
constexpr double kLargestStepFactor = 2;
/// What an error of the readout by a millisecond counts [px]: a camera that turns by 30 degrees in a second.
constexpr double kReadoutPixels = 0.25;

double step_between(const CameraCalibration& a, const CameraCalibration& b) {
  return largest_shift(a, b) + kReadoutPixels * std::abs(a.readout_ms - b.readout_ms);
}

}  // namespace

CalibrationSearch::CalibrationSearch(Calibration given, const SelfCalibrationSettings& settings)
    : given_(std::move(given)), calibration_(given_), settings_(settings) {
  if (!settings_.enabled || settings_.passes < 2) state_ = State::kKept;
}

bool CalibrationSearch::begins_anew(const CalibrationFindings& findings) {
  ++passes_;
  if (state_ == State::kGiven) {
    if (!(findings.deviations > settings_.significance)) {
      state_ = State::kKept;
      return false;
    }
    fits_ = findings.fits;
    state_ = State::kTrying;
    return try_next(findings);
  }
  const bool moves_on = findings.deviations > kTriedSignificance && passes_ < settings_.passes;
  return moves_on ? try_next(findings) : prove(findings);
}

bool CalibrationSearch::try_next(const CalibrationFindings& findings) {
  Calibration better = findings.better;
  const double step = step_between(calibration_.camera, better.camera);
  if (const FitChange change = compare_fits(fits_, findings.fits); change.is_known && change.residual > 0) {
    return refuse(format_text("residuals have become larger by %.2f %%", 100 * change.residual));
  }
  const bool is_noise = findings.deviations < settings_.significance;
  if (passes_ > 2 && !is_noise && step > kLargestStepFactor * step_) {
    return refuse("it does not come to rest: from one pass to the next it changed by " +
                  format_text("%.1f px after %.1f px", step, step_));
  }
  step_ = step;
  calibration_ = std::move(better);
  return true;
}

bool CalibrationSearch::prove(const CalibrationFindings& findings) {
  const FitChange change = compare_fits(fits_, findings.fits);
  if (!change.is_known) return refuse("too few windows saw the same frames with both");
  const std::string figures =
      format_text("residuals changed by %.2f +- %.2f %%, by %.2f %% where least, inliers by %.1f %%",
                  100 * change.residual, 100 * change.stddev, 100 * change.worst, 100 * change.inlier_share);
  if (!is_better(change)) return refuse(figures + ", which proves nothing");
  state_ = State::kProven;
  proof_ = figures;
  return false;
}

bool CalibrationSearch::refuse(const std::string& why) {
  state_ = State::kRefused;
  refusal_ = describe_change(given_.camera, calibration_.camera) + ": " + why;
  calibration_ = given_;
  return true;
}

}  // namespace ldso
