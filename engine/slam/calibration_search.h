#pragma once

// From pass to pass over a sequence: which calibration the next one is run with, until one has proven itself or all
// are refused. A calibration that was given is only left for one that the windows agree on, that stays where it is
// when the run begins anew with it, and with which the same frames are explained better.

#include <string>

#include "ldso/calibration.h"
#include "ldso/settings.h"
#include "slam/calibration_watch.h"

namespace ldso {

class CalibrationSearch {
 public:
  CalibrationSearch(Calibration given, const SelfCalibrationSettings& settings);

  /// What it began with.
  const Calibration& given() const { return given_; }
  /// What the next pass is to be run with.
  const Calibration& calibration() const { return calibration_; }
  /// Whether that pass is to be watched.
  bool is_open() const { return state_ == State::kGiven || state_ == State::kTrying; }
  /// Whether the findings of the frames so far speak so clearly that the other ones need not be waited for: that the
  /// next pass is needed is certain, and that one tells more than the rest of this one.
  bool is_clear(const CalibrationFindings& findings) const;
  /// To be called once, after the watched frames of a pass with calibration(). True if it is to begin anew.
  bool begins_anew(const CalibrationFindings& findings);

  /// By how many of its standard deviations the newest pass contradicted its calibration.
  double deviations() const { return deviations_; }
  /// Whether the windows of a pass contradicted each other: then what they say together counts less than it is wrong.
  bool is_disputed() const { return is_disputed_; }
  /// Passes that were watched.
  int passes() const { return passes_; }
  bool is_corrected() const { return state_ == State::kProven; }
  /// How well the windows of the last pass knew the lens.
  const LensVector& stddevs() const { return stddevs_; }
  /// What spoke for the correction, if it was accepted.
  const std::string& proof() const { return proof_; }
  /// Why a contradiction was not followed; empty if there was none or the correction was accepted.
  const std::string& refusal() const { return refusal_; }

 private:
  enum class State { kGiven, kTrying, kKept, kProven, kRefused };

  /// Deviations that contradict the calibration of this pass.
  double contradiction() const;
  bool contradicts(const CalibrationFindings& findings) const;
  /// What speaks against another pass after this one, the `pass`-th, or nothing.
  std::string objection(const CalibrationFindings& findings, int pass) const;
  bool try_next(const CalibrationFindings& findings);
  bool prove(const CalibrationFindings& findings);
  /// Whether the windows of the first and the last pass speak so plainly that the residuals need to say little.
  bool is_plain(const FitChange& change, const CalibrationFindings& findings) const;
  bool accept(const std::string& proof);
  bool refuse(const std::string& why);

  Calibration given_, calibration_;
  SelfCalibrationSettings settings_;
  State state_ = State::kGiven;
  std::vector<WindowFit> fits_;  ///< With the given calibration.
  double first_deviations_ = 0;  ///< That contradict it.
  double deviations_ = 0;        ///< The same of the newest pass.
  double step_ = 0;              ///< The last change of the calibration [px].
  int passes_ = 0;
  bool is_disputed_ = false;
  LensVector stddevs_ = LensVector::Zero();
  std::string refusal_, proof_;
};

}  // namespace ldso
