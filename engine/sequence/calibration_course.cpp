#include "sequence/calibration_course.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/working_size.h"
#include "ldso/error.h"
#include "sequence/camera_finder.h"
#include "util/format_text.h"
#include "util/log.h"

namespace ldso {
namespace {

/// Standard deviations by which the images must contradict a camera that was found.
constexpr double kFoundSignificance = 3;
/// Standard deviation of the focal length, as a share of it, from which on it is unknown.
constexpr double kLeastKnownFocal = 0.01;
/// Share of the frames that a camera has to give a pose to: with a wrong one the map begins late and is lost again.
constexpr double kLeastPosed = 0.5;
/// A given calibration that was refused to be mended, though it is contradicted by so many times what is needed or the
/// windows contradict each other, may be another camera's.
constexpr double kOtherSignificance = 2;

/// What the search begins with.
CameraFinding first_calibration(const FrameSource& source, const Settings& settings, const LogSink& log,
                                const std::atomic<bool>* stop) {
  if (!source.calibration().is_guess()) return {with_longest_side(source.calibration(), settings.longest_side), {}};
  if (!settings.self_calibration.enabled) {
    throw Error("calibration", "there is none of the camera",
                "give one with --calib, or let self_calibration.enabled=true look for it");
  }
  log_to(log, LogLevel::kInfo, "there is no calibration of the camera: looking for it");
  return find_camera(source, settings, log, stop);
}

/// What was only found is left sooner for something better than what somebody has measured.
SelfCalibrationSettings search_settings(const Calibration& given, SelfCalibrationSettings settings) {
  if (given.is_guess()) settings.significance = std::min(settings.significance, kFoundSignificance);
  return settings;
}

CalibrationSearch new_search(Calibration begin, const SelfCalibrationSettings& settings) {
  const SelfCalibrationSettings own = search_settings(begin, settings);
  return {std::move(begin), own};
}

/// Why the frames speak against the camera that they were run with; empty if they do not.
std::string objection_of(const std::vector<FrameRecord>& frames) {
  const auto posed = std::ranges::count(frames, TrackingState::kTracked, &FrameRecord::state);
  if (static_cast<double>(posed) >= kLeastPosed * static_cast<double>(frames.size())) return {};
  return format_text("only %d of %d frames have a pose with the one that fits best", static_cast<int>(posed),
                     static_cast<int>(frames.size()));
}

void log_trial(const CalibrationSearch& search, const LogSink& log) {
  log_to(log, LogLevel::kWarning,
         (search.given().is_guess() ? "the images speak for " : "the images contradict the calibration: ") +
             describe_change(search.given().camera, search.calibration().camera) +
             format_text(" (%.0f standard deviations)", search.deviations()) +
             "; starting again to see whether that is better");
}

}  // namespace

CalibrationCourse::CalibrationCourse(const FrameSource& source, const Settings& settings, const LogSink& log,
                                     const std::atomic<bool>* stop)
    : source_(source), settings_(settings), log_(log), stop_(stop), search_({}, settings.self_calibration) {
  CameraFinding first = first_calibration(source, settings, log, stop);
  doubt_ = std::move(first.doubt);
  search_ = new_search(std::move(first.calibration), settings.self_calibration);
}

Calibration CalibrationCourse::calibration() const {
  Calibration calibration = search_.calibration();
  calibration.source = source_.calibration().source;  // Another camera in the place of a given one is no guess.
  return calibration;
}

void CalibrationCourse::begin_anew() {
  if (search_.is_open()) return log_trial(search_, log_);
  log_to(log_, LogLevel::kWarning,
         "the calibration stands. Refused: " + search_.refusal() + "; starting again with it");
  // What took the place of the given one was proven when it was found: nothing else is looked for.
  if (is_guess() || !elsewhere_proof_.empty()) return;
  const double needed = kOtherSignificance * std::max(kFoundSignificance, settings_.self_calibration.significance);
  if (search_.deviations() > needed || search_.is_disputed()) look_elsewhere();
}

void CalibrationCourse::look_elsewhere() {
  log_to(log_, LogLevel::kInfo, "it may be another camera's: looking for one that explains the images");
  const std::optional<OtherCamera> other = find_other_camera(source_, search_.given(), settings_, log_, stop_);
  if (!other) return;
  elsewhere_proof_ = other->proof;
  log_to(log_, LogLevel::kWarning,
         "the calibration seems to be another camera's: " +
             describe_change(search_.given().camera, other->calibration.camera) + ": " + elsewhere_proof_ +
             "; starting again with that one");
  search_ = new_search(other->calibration, settings_.self_calibration);
}

void CalibrationCourse::note(SequenceRun& run) const {
  run.is_corrected = search_.is_corrected() || !elsewhere_proof_.empty();
  run.proof = elsewhere_proof_;
  if (!search_.proof().empty()) run.proof += (run.proof.empty() ? "" : "; then ") + search_.proof();
  run.refused_correction = elsewhere_proof_.empty() ? search_.refusal() : "";
}

void CalibrationCourse::note_found_camera(SequenceRun& run) const {
  if (!is_guess()) return;
  FoundCamera found;
  std::copy_n(search_.stddevs().data(), found.stddevs.size(), found.stddevs.begin());
  const CameraCalibration& camera = search_.calibration().camera;
  const double share = found.stddevs[0] / camera.fx;
  // What the windows of one camera say does not count while another one may be the right one.
  found.doubt = doubt_.empty() ? search_.refusal() : doubt_;
  if (found.doubt.empty()) found.doubt = objection_of(run.result.frames);
  if (found.doubt.empty() && !(share > 0 && share < kLeastKnownFocal))
    found.doubt = format_text("the motion tells the focal length only to %.1f %%", 100 * share);
  if (!found.doubt.empty()) {
    log_to(log_, LogLevel::kWarning,
           "nobody calibrated the camera, and this sequence does not tell how it sees: " + found.doubt +
               ". The shape of trajectory and map may be wrong. Film something at several distances, moving sideways "
               "and turning, or give a calibration with --calib");
  }
  run.found_camera = std::move(found);
}

}  // namespace ldso
