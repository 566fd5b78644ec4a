#include "slam/calibration_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "util/format_text.h"

namespace ldso {
namespace {

/// A calibration that is being tried has to stay where it is but for so many standard deviations.
constexpr double kTriedSignificance = 3;
/// Squared distance of the windows from what they say together, in their own variance, from which on they contradict
/// each other. Measured: right lenses 1.0-1.2 on rendered worlds, the kitchen and KITTI; distortion left out 3.2-10, a
/// focal length 10 % off 5. It widens what they say together, which is off by fewer standard deviations then.
constexpr double kLargestDisagreement = 2.5;
/// Deviations of so many times what is needed are clear before all frames have been seen.
constexpr double kClear = 2;
/// Runs with calibrations that are equally good have residuals that differ by this share, or by so many of the standard
/// deviations that show in it.
constexpr double kNoWorse = 0.01;
constexpr double kWorseSignificance = 2;
/// Nobody vouches for a guess: it is left for what the windows say unless residuals become larger by this share.
constexpr double kGuessNoWorse = 0.05;
/// In the end so many deviations are left at most.
constexpr double kGuessDeviations = 6;
/// What was contradicted by so many times what is needed, and is not contradicted any more with the better calibration,
/// needs less proof from the residuals: an improvement of the middle stretch. If it was by still more, it is enough
/// that they are no worse, but for what shows in them by chance: windows move their own focal lengths, and have the
/// same residuals then.
constexpr double kPlain = 2;
constexpr double kVeryPlain = 3;
constexpr double kSameResidual = 0.003;
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

bool CalibrationSearch::contradicts(const CalibrationFindings& findings) const {
  const bool is_disputed = findings.disagreement > kLargestDisagreement;
  return findings.deviations > (is_disputed ? kTriedSignificance : contradiction());
}

bool CalibrationSearch::is_clear(const CalibrationFindings& findings) const {
  const bool comes_again = passes_ + 2 < settings_.passes;  // The last one is to see all frames.
  return comes_again && findings.fits.size() >= kLeastFits && findings.deviations > kClear * contradiction() &&
         objection(findings, passes_ + 1).empty();
}

bool CalibrationSearch::begins_anew(const CalibrationFindings& findings) {
  ++passes_;
  stddevs_ = findings.stddevs;
  deviations_ = findings.deviations;
  is_disputed_ = is_disputed_ || findings.disagreement > kLargestDisagreement;
  const bool goes_on = contradicts(findings);
  if (state_ == State::kTrying) return goes_on && passes_ < settings_.passes ? try_next(findings) : prove(findings);
  state_ = goes_on ? State::kTrying : State::kKept;
  if (!goes_on) return false;
  fits_ = findings.fits;
  first_deviations_ = findings.deviations;
  return try_next(findings);
}

std::string CalibrationSearch::objection(const CalibrationFindings& findings, int pass) const {
  const FitChange change = compare_fits(fits_, findings.fits);
  const double most = given_.is_guess() ? kGuessNoWorse : std::max(kNoWorse, kWorseSignificance * change.stddev);
  if (change.is_known && change.residual > most) {
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
  std::string figures = format_text("it was contradicted by %.0f standard deviations, the better one is by %.0f",
                                    first_deviations_, findings.deviations);
  if (change.is_known) {
    figures += format_text("; residuals changed by %.2f +- %.2f %%, by %.2f %% where least, inliers by %.1f %%",
                           100 * change.residual, 100 * change.stddev, 100 * change.worst, 100 * change.inlier_share);
  }
  if (given_.is_guess()) {
    // Too few windows in common leave the residual as it is: 0.
    const bool is_lenient = findings.deviations < kGuessDeviations && change.median < kGuessNoWorse;
    return is_lenient || (change.is_known && is_better(change)) ? accept(figures) : refuse(figures);
  }
  if (!change.is_known) return refuse("too few windows saw the same frames with both");
  // On its way, but not there: what it is on its way to may be another lens altogether.
  if (findings.deviations > kPlain * settings_.significance)
    return refuse(figures + ", but it is not where it has to be");
  return is_better(change) || is_plain(change, findings) ? accept(figures) : refuse(figures + ", which proves nothing");
}

bool CalibrationSearch::accept(const std::string& proof) {
  state_ = State::kProven;
  proof_ = proof;
  return false;
}

bool CalibrationSearch::is_plain(const FitChange& change, const CalibrationFindings& findings) const {
  if (findings.deviations > contradiction()) return false;
  const double deviations = first_deviations_ / settings_.significance;
  return (deviations > kPlain && change.median < -kSameResidual) ||
         (deviations > kVeryPlain && change.median < std::max(kSameResidual, change.stddev));
}

bool CalibrationSearch::refuse(const std::string& why) {
  state_ = State::kRefused;
  refusal_ = describe_change(given_.camera, calibration_.camera) + ": " + why;
  calibration_ = given_;
  return true;
}

}  // namespace ldso
