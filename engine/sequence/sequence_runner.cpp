#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "image/working_size.h"
#include "ldso/error.h"
#include "ldso/sequence_run.h"
#include "sequence/camera_finder.h"
#include "sequence/checkpoint_clock.h"
#include "sequence/ready_frame.h"
#include "slam/calibration_search.h"
#include "util/format_text.h"
#include "util/log.h"
#include "util/out_of_memory.h"
#include "util/prefetching_reader.h"

namespace ldso {
namespace {

/// Standard deviations by which the images must contradict a camera that was found.
constexpr double kFoundSignificance = 3;
/// Standard deviation of the focal length, as a share of it, from which on it is unknown.
constexpr double kLeastKnownFocal = 0.01;

using Clock = std::chrono::steady_clock;

using Reader = PrefetchingReader<ReadyFrame>;

const FrameRecord& process(const FrameSource& source, Pipeline& pipeline, const Reader::Item& item) {
  if (!item.value) return pipeline.skip(item.index, source.timestamp(item.index), item.error);
  return feed(pipeline, *item.value);
}

bool must_stop(const RunOptions& options) { return options.stop != nullptr && options.stop->load(); }

/// What ends a pass over the sequence.
enum class PassEnd { kDone, kStopped, kBeginsAnew };

/// What the search has come to.
void note_search(const CalibrationSearch& search, SequenceRun& run) {
  run.is_corrected = search.is_corrected();
  run.proof = search.proof();
  run.refused_correction = search.refusal();
}

/// One pass over the sequence with one calibration.
class Pass {
 public:
  /// `run`: all but the result, with the calibration of this pass. It must outlive this.
  Pass(const FrameSource& source, SequenceRun& run, const Settings& settings, const LogSink& log,
       const RunOptions& options)
      : source_(source), run_(run), log_(log), pipeline_(run.calibration, settings, log, options.observer) {}

  /// `search` hears of the first frames and says whether to go on. It must outlive this.
  void watch_for(CalibrationSearch& search, const SelfCalibrationSettings& settings) {
    search_ = &search;
    watch_.emplace(search.calibration(), settings, pipeline_);
    pipeline_.postpone_revision(true);
  }

  PassEnd run(const RunOptions& options, CheckpointClock& checkpoints) {
    const FramePreprocessor& preprocessor = pipeline_.preprocessor();
    Reader reader(source_.size(),
                  [&](int index) { return make_ready([&] { return source_.read(index); }, preprocessor); });
    for (done_ = 0; done_ < source_.size(); ++done_) {
      if (must_stop(options)) return PassEnd::kStopped;
      std::optional<Reader::Item> item;
      {
        const StageTimer timer(pipeline_.times(), "wait_for_frame");
        item = reader.next();
      }
      if (!item) break;
      const FrameRecord& frame = process(source_, pipeline_, *item);
      if (options.progress) options.progress({done_ + 1, source_.size(), pipeline_.keyframes(), frame, 0});
      checkpoints.after_frame(pipeline_, run_);
      if (is_decided(frame) && begins_anew()) return PassEnd::kBeginsAnew;
    }
    return watch_ && begins_anew() ? PassEnd::kBeginsAnew : PassEnd::kDone;
  }

  SlamResult finish() { return pipeline_.finish(); }
  int done() const { return done_; }  ///< Frames.

 private:
  /// Whether the frames so far tell what becomes of the calibration.
  bool is_decided(const FrameRecord& frame) {
    if (!watch_) return false;
    const bool is_new = watch_->add(frame, pipeline_);
    return watch_->is_over() || (is_new && search_->is_clear(watch_->findings()));
  }

  /// Once, when that is so.
  bool begins_anew() {
    const bool anew = search_->begins_anew(watch_->findings());
    watch_.reset();
    pipeline_.postpone_revision(false);
    note_search(*search_, run_);
    if (search_->is_corrected()) log_to(log_, LogLevel::kWarning, "the better calibration stands: " + search_->proof());
    return anew;
  }

  const FrameSource& source_;
  SequenceRun& run_;
  const LogSink& log_;
  Pipeline pipeline_;
  int done_ = 0;
  CalibrationSearch* search_ = nullptr;
  std::optional<CalibrationWatch> watch_;
};

void log_next(const CalibrationSearch& search, const LogSink& log) {
  if (search.is_open()) {
    log_to(log, LogLevel::kWarning,
           (search.given().is_guess() ? "the images speak for " : "the images contradict the calibration: ") +
               describe_change(search.given().camera, search.calibration().camera) +
               format_text(" (%.0f standard deviations)", search.deviations()) +
               "; starting again to see whether that is better");
  } else {
    log_to(log, LogLevel::kWarning,
           "the calibration stands. Refused: " + search.refusal() + "; starting again with it");
  }
}

/// What the search begins with.
CameraFinding first_calibration(const FrameSource& source, const Settings& settings, const LogSink& log,
                                const RunOptions& options) {
  if (!source.calibration().is_guess()) return {with_longest_side(source.calibration(), settings.longest_side), {}};
  if (!settings.self_calibration.enabled) {
    throw Error("calibration", "there is none of the camera",
                "give one with --calib, or let self_calibration.enabled=true look for it");
  }
  log_to(log, LogLevel::kInfo, "there is no calibration of the camera: looking for it");
  return find_camera(source, settings, log, options.stop);
}

/// What was only found is left sooner for something better than what somebody has measured.
SelfCalibrationSettings search_settings(const Calibration& given, SelfCalibrationSettings settings) {
  if (given.is_guess()) settings.significance = std::min(settings.significance, kFoundSignificance);
  return settings;
}

FoundCamera found_camera(const CalibrationSearch& search, const std::string& doubt, const LogSink& log) {
  FoundCamera found;
  std::copy_n(search.stddevs().data(), found.stddevs.size(), found.stddevs.begin());
  const CameraCalibration& camera = search.calibration().camera;
  const double share = found.stddevs[0] / camera.fx;
  // What the windows of one camera say does not count while another one may be the right one.
  found.doubt = doubt.empty() ? search.refusal() : doubt;
  if (found.doubt.empty() && !(share > 0 && share < kLeastKnownFocal))
    found.doubt = format_text("the motion tells the focal length only to %.1f %%", 100 * share);
  if (!found.doubt.empty()) {
    log_to(log, LogLevel::kWarning,
           "nobody calibrated the camera, and this sequence does not tell how it sees: " + found.doubt +
               ". The shape of trajectory and map may be wrong. Film something at several distances, moving sideways "
               "and turning, or give a calibration with --calib");
  }
  return found;
}

/// A failure ends the pass where it is.
PassEnd run_pass(Pass& pass, const RunOptions& options, CheckpointClock& checkpoints, SequenceRun& run) {
  try {
    return pass.run(options, checkpoints);
  } catch (const std::exception& failure) {
    run.error = problem_of(failure, "processing frame " + std::to_string(pass.done()));
    return PassEnd::kDone;
  }
}

}  // namespace

SequenceRun run_sequence(const FrameSource& source, const Settings& settings, const LogSink& log,
                         const RunOptions& options) {
  SequenceRun run;
  const Clock::time_point start = Clock::now();
  CheckpointClock checkpoints(options);
  const CameraFinding first = first_calibration(source, settings, log, options);
  CalibrationSearch search(first.calibration, search_settings(source.calibration(), settings.self_calibration));
  for (run.passes = 1;; ++run.passes) {
    run.calibration = search.calibration();
    Pass pass(source, run, settings, log, options);
    if (search.is_open()) pass.watch_for(search, settings.self_calibration);
    const PassEnd end = run_pass(pass, options, checkpoints, run);
    if (end == PassEnd::kBeginsAnew) {
      log_next(search, log);
      continue;
    }
    note_search(search, run);
    if (source.calibration().is_guess()) run.found_camera = found_camera(search, first.doubt, log);
    run.stopped = end == PassEnd::kStopped;
    run.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    run.result = pass.finish();
    return run;
  }
}

}  // namespace ldso
