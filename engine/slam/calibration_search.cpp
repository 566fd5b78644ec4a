#include "slam/calibration_search.h"

#include <cmath>
#include <utility>

#include "util/format_text.h"

namespace ldso {
namespace {

/// A calibration that is being tried has to stay where it is but for so many standard deviations.
constexpr double kTriedSignificance = 3;
/// Deviations of so many times what is needed are clear before all frames have been seen.
constexpr double kClear = 2;
/// So many windows of the first pass are enough to compare those of a later one with.
constexpr std::size_t kLeastFits = 24;
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

double CalibrationSearch::contradiction() const {
  return state_ == State::kGiven ? settings_.significance : kTriedSignificance;
}

bool CalibrationSearch::is_clear(const CalibrationFindings& findings) const {
  const bool comes_again = passes_ + 2 < settings_.passes;  // The last one is to see all frames.
  return comes_again && findings.fits.size() >= kLeastFits && findings.deviations > kClear * contradiction() &&
         objection(findings, passes_ + 1).empty();
}

bool CalibrationSearch::begins_anew(const CalibrationFindings& findings) {
  ++passes_;
  const bool contradicts = findings.deviations > contradiction();
  if (state_ == State::kTrying) return contradicts && passes_ < settings_.passes ? try_next(findings) : prove(findings);
  state_ = contradicts ? State::kTrying : State::kKept;
  if (!contradicts) return false;
  fits_ = findings.fits;
  return try_next(findings);
}

std::string CalibrationSearch::objection(const CalibrationFindings& findings, int pass) const {
  if (const FitChange change = compare_fits(fits_, findings.fits); change.is_known && change.residual > 0) {
    return format_text("residuals have become larger by %.2f %%", 100 * change.residual);
  }
  const double step = step_between(calibration_.camera, findings.better.camera);
  const bool is_noise = findings.deviations < settings_.significance;
  if (pass > 2 && !is_noise && step > kLargestStepFactor * step_) {
    return "it does not come to rest: from one pass to the next it changed by " +
           format_text("%.1f px after %.1f px", step, step_);
  }
  return {};
}

bool CalibrationSearch::try_next(const CalibrationFindings& findings) {
  if (const std::string reason = objection(findings, passes_); !reason.empty()) return refuse(reason);
  step_ = step_between(calibration_.camera, findings.better.camera);
  calibration_ = findings.better;
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
