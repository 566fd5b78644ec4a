#include "doctor/trial_run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "slam/calibration_watch.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// Fewer frames than this do not contradict a calibration: they are too few to be corrected by as well.
constexpr int kEnoughFrames = 120;

/// A start that takes longer is worth a word [s].
constexpr double kLateStart = 3;

/// The beginning of another sequence.
class Beginning final : public FrameSource {
 public:
  Beginning(const Dataset& whole, int frames) : whole_(whole), size_(std::min(frames, whole.size())) {}

  int size() const override { return size_; }
  RawFrame read(int index) const override { return whole_.read(index); }
  double timestamp(int index) const override { return whole_.timestamp(index); }
  const Calibration& calibration() const override { return whole_.calibration(); }

 private:
  const Dataset& whole_;
  int size_;
};

/// The reason, but for its figures, that most frames without a pose had, in the words of the last of them.
std::string usual_reason(const std::vector<FrameRecord>& frames, std::int64_t before) {
  std::map<std::string, std::pair<int, std::string>> reasons;
  for (const FrameRecord& frame : frames) {
    if (frame.frame_id >= before || frame.reason.empty()) continue;
    auto& [count, words] = reasons[without_numbers(frame.reason)];
    ++count;
    words = frame.reason;
  }
  const auto most = std::max_element(reasons.begin(), reasons.end(),
                                     [](const auto& a, const auto& b) { return a.second.first < b.second.first; });
  return most == reasons.end() ? "no reason is known" : most->second.second;
}

bool says(const std::string& reason, const char* words) { return reason.find(words) != std::string::npos; }

std::string remedy_of(const std::string& reason) {
  if (says(reason, "only turned"))
    return "the camera turns on the spot, or everything is far away: move it sideways or forward past things at "
           "different distances";
  if (says(reason, "not moved enough"))
    return "move the camera, sideways or forward past things at different distances; leave out the part in which it "
           "stands (--start)";
  if (says(reason, "no camera motion explains"))
    return "check the calibration (is it of this camera, this lens and this image size?), switch off the "
           "stabilization, "
           "and mask what moves by itself (--mask)";
  return "begin with a calm motion sideways or forward past things at different distances";
}

double seconds_to(const Dataset& dataset, std::int64_t frame) {
  const int last = static_cast<int>(std::min<std::int64_t>(frame, dataset.size() - 1));
  return std::abs(dataset.timestamp(last) - dataset.timestamp(0));
}

void add_start(const TrialRun& trial, const Dataset& dataset, Findings& findings) {
  const SlamResult& result = trial.run.result;
  if (result.initializations.empty()) {
    const std::string reason = usual_reason(result.frames, trial.frames);
    findings.push_back({"motion.no_start", Severity::kWarning, 80,
                        format_text("no map begins within the first %d frames (%.1f s): ", trial.frames,
                                    seconds_to(dataset, trial.frames)) +
                            reason,
                        remedy_of(reason)});
    return;
  }
  const std::int64_t first = result.initializations.front();
  if (seconds_to(dataset, first) < kLateStart) return;
  const std::string reason = usual_reason(result.frames, first);
  findings.push_back({"motion.late_start", Severity::kNote, 30,
                      format_text("the map begins at frame %lld only, after %.1f s: ", static_cast<long long>(first),
                                  seconds_to(dataset, first)) +
                          reason,
                      remedy_of(reason)});
}

/// Of a camera that nobody had calibrated.
void add_unknown_camera(const TrialRun& trial, Findings& findings) {
  const CameraCalibration& found = trial.run.calibration.camera;
  const std::string doubt = trial.run.found_camera ? trial.run.found_camera->doubt : "no map began";
  const std::string focal = format_text("focal length %.1f px", found.fx);
  if (doubt.empty()) {
    findings.push_back(
        {"calibration.found", Severity::kNote, 35, "there is no calibration; the first frames say: " + focal,
         "`ldso run` finds it by itself and leaves it as camera.txt in its results; a calibration of your "
         "own is better"});
  } else {
    findings.push_back(
        {"calibration.unknown", Severity::kWarning, 82,
         "there is no calibration, and the first frames do not tell it (" + doubt + ")",
         "give one by --calib, or film things at different distances while moving sideways and turning"});
  }
}

void add_calibration(const TrialRun& trial, const Dataset& dataset, Findings& findings) {
  if (dataset.calibration().is_guess()) return add_unknown_camera(trial, findings);
  const CameraCalibration &given = dataset.calibration().camera, &found = trial.run.calibration.camera;
  if (!trial.run.is_corrected) return;
  if (given.readout_ms == 0 && found.readout_ms != 0) {
    findings.push_back(
        {"shutter.rolling", Severity::kNote, 40,
         format_text("the shutter rolls: from the first row to the last it takes %.1f ms", found.readout_ms),
         format_text("`ldso run` corrects it by itself; written into camera.txt as a fifth line, "
                     "rolling_shutter %.1f, it is known from the start",
                     found.readout_ms)});
  }
  const double change = std::max(std::abs(found.fx / given.fx - 1), std::abs(found.fy / given.fy - 1));
  const double share = 100 * change;
  if (change < 0.01 || trial.frames < kEnoughFrames) {
    if (given.readout_ms != 0 || found.readout_ms == 0)
      findings.push_back({"calibration.improved", Severity::kNote, 35,
                          "the images speak for another calibration: " + describe_change(given, found),
                          "`ldso run` uses it by itself and leaves it as camera.txt in its results"});
    return;
  }
  findings.push_back({"calibration.contradicted", Severity::kWarning, 75 + share,
                      "the images contradict the calibration: " + describe_change(given, found),
                      "calibrate again with the focus, zoom and image size of the recording; until then `ldso run` "
                      "corrects it by itself and leaves what it found as camera.txt in its results"});
}

}  // namespace

TrialRun try_sequence(const Dataset& dataset, int frames, const std::function<void(int, int)>& progress) {
  const Beginning beginning(dataset, frames);
  Settings settings;
  settings.loops.enabled = false;
  TrialRun trial;
  trial.frames = beginning.size();
  const auto log = [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning && says(text, " is lost")) trial.losses.push_back(text);
  };
  RunOptions options;
  if (progress) options.progress = [&](const RunProgress& p) { progress(p.done, p.count); };
  trial.run = run_sequence(beginning, settings, log, options);
  return trial;
}

Findings trial_findings(const TrialRun& trial, const Dataset& dataset) {
  Findings findings;
  if (!trial.run.error.empty()) {
    findings.push_back(
        {"run.failed", Severity::kError, 100, "a run of the first frames fails: " + trial.run.error, ""});
    return findings;
  }
  add_start(trial, dataset, findings);
  if (trial.run.result.restarts > 0 || !trial.losses.empty()) {
    const std::string first = trial.losses.empty() ? "" : "; " + trial.losses.front();
    findings.push_back({"motion.lost", Severity::kWarning, 72,
                        format_text("tracking is lost within the first %d frames", trial.frames) + first,
                        "see the other findings; calmer motion, a shorter exposure, a mask for what moves by itself"});
  }
  add_calibration(trial, dataset, findings);
  if (!trial.run.refused_correction.empty()) {
    findings.push_back(
        {"calibration.doubtful", Severity::kNote, 45,
         "the images speak against the calibration, but another one is not better: " + trial.run.refused_correction,
         "check that it is of this camera and this image size, and that nothing stabilizes the images"});
  }
  return findings;
}

}  // namespace ldso
