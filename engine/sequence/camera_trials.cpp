#include "sequence/camera_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "sequence/ready_frame.h"
#include "slam/pipeline.h"
#include "slam/window_fit.h"
#include "util/format_text.h"
#include "util/prefetching_reader.h"

namespace ldso {
namespace {

/// Frames at most, and windows and frames that are enough: where nearly every frame is a keyframe, few frames show
/// little of how the camera turns, which is what tells its focal length.
constexpr int kMostFrames = 300;
constexpr std::size_t kEnoughWindows = 24;
constexpr int kEnoughFrames = 160;
/// Fewer points tell the cameras apart as well, and sooner.
constexpr int kCandidates = 1000;
constexpr int kActivePoints = 1200;
/// What the windows say of the lens counts from so many standard deviations on.
constexpr double kSignificance = 3;
/// Windows that two trials must share to be compared, and the share of the other's frames below which one has failed.
constexpr std::size_t kLeastShared = 6;
constexpr double kLeastShare = 0.4;

/// Without what a trial does not need.
Settings trial_settings(Settings settings) {
  settings.loops.enabled = false;
  settings.revision.enabled = false;
  settings.selection.candidates = std::min(settings.selection.candidates, kCandidates);
  settings.window.active_points = std::min(settings.window.active_points, kActivePoints);
  settings.self_calibration.frames = kMostFrames;
  settings.self_calibration.significance = kSignificance;
  return settings;
}

/// From the first window to the last.
double covered_frames(const CameraTrial& trial) {
  const std::vector<WindowFit>& fits = trial.findings.fits;
  return fits.empty() ? 0.0 : static_cast<double>(fits.back().frame_id - fits.front().frame_id + 1);
}

}  // namespace

double CameraTrial::log_focal() const { return std::log(camera.camera.fx); }

double CameraTrial::step() const {
  return findings.deviations > kSignificance ? std::log(findings.better.camera.fx / camera.camera.fx) : 0;
}

CameraTrials::CameraTrials(const FrameSource& source, const Settings& settings, const std::atomic<bool>* stop)
    : source_(source),
      settings_(trial_settings(settings)),
      stop_(stop),
      frames_(std::min(source.size(), kMostFrames)) {}

CameraTrial CameraTrials::run(const Calibration& camera, int family) {
  Pipeline pipeline(camera, settings_, {});
  CalibrationWatch watch(camera, settings_.self_calibration, pipeline);
  const FramePreprocessor& preprocessor = pipeline.preprocessor();
  PrefetchingReader<ReadyFrame> reader(
      frames_, [&](int index) { return make_ready([&] { return source_.read(index); }, preprocessor); });
  int frames = 0;
  while (const auto item = reader.next()) {
    if (is_stopped()) break;
    ++frames;
    const FrameRecord& frame = item->value ? feed(pipeline, *item->value)
                                           : pipeline.skip(item->index, source_.timestamp(item->index), item->error);
    const bool is_new = watch.add(frame, pipeline);
    if (is_fixed_ || !is_new || frames < kEnoughFrames || watch.windows() < kEnoughWindows) continue;
    frames_ = frames;
    is_fixed_ = true;
    break;
  }
  return {camera, watch.findings(), family};
}

double residual_change(const CameraTrial& a, const CameraTrial& b) {
  constexpr double kFailed = std::numeric_limits<double>::infinity();
  const double frames_a = covered_frames(a), frames_b = covered_frames(b);
  if (frames_b < kLeastShare * frames_a) return kFailed;
  if (frames_a < kLeastShare * frames_b) return -kFailed;
  const std::optional<WindowFit> change = mean_difference(a.findings.fits, b.findings.fits, kLeastShared);
  if (!change) return frames_b < frames_a ? kFailed : -kFailed;
  return change->log_rmse - kShrinkByLoss * change->log_inlier_share;
}

std::string describe(const CameraTrial& trial) {
  const CameraCalibration& camera = trial.camera.camera;
  std::string text = format_text("focal length %.1f px, distortion %.2f: ", camera.fx, camera.distortion[0]);
  if (!trial.has_map()) return text + "no map";
  double rmse = 0, share = 0;
  const auto count = static_cast<double>(trial.findings.fits.size());
  for (const WindowFit& fit : trial.findings.fits) {
    rmse += std::exp(fit.log_rmse) / count;
    share += std::exp(fit.log_inlier_share) / count;
  }
  text += format_text("residuals of %.2f grey levels, inliers %.0f %%", rmse, 100 * share);
  const CameraCalibration& better = trial.findings.better.camera;
  if (trial.step() != 0) text += format_text("; the windows speak for %.1f px, %.3f", better.fx, better.distortion[0]);
  return text;
}

}  // namespace ldso
