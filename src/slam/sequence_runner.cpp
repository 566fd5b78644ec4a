#include "slam/sequence_runner.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "io/prefetching_reader.h"
#include "slam/self_calibration.h"
#include "util/log.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

/// A frame as the reading thread hands it over.
struct ReadyFrame {
  std::shared_ptr<const PreparedFrame> frame;
  double decode_ms = 0;
  double preprocess_ms = 0;
};

using Reader = PrefetchingReader<ReadyFrame>;

ReadyFrame prepare(const Dataset& dataset, const FramePreprocessor& preprocessor, int index) {
  const Clock::time_point start = Clock::now();
  const RawFrame raw = dataset.read(index);
  const Clock::time_point decoded = Clock::now();
  ReadyFrame ready;
  ready.frame = std::make_shared<const PreparedFrame>(preprocessor.process(raw));
  ready.decode_ms = milliseconds(start, decoded);
  ready.preprocess_ms = milliseconds(decoded, Clock::now());
  return ready;
}

const FrameRecord& process(const Dataset& dataset, Pipeline& pipeline, const Reader::Item& item) {
  if (!item.value) return pipeline.skip(item.index, dataset.timestamp(item.index), item.error);
  pipeline.times().add("decode", item.value->decode_ms);
  pipeline.times().add("preprocess", item.value->preprocess_ms);
  return pipeline.process(item.value->frame);
}

bool must_stop(const RunOptions& options) { return options.stop != nullptr && options.stop->load(); }

/// What ends a pass over the sequence.
enum class PassEnd { kDone, kStopped, kBetterCalibration };

/// One pass over the sequence with one calibration.
class Pass {
 public:
  Pass(const Dataset& dataset, const Calibration& calibration, const Settings& settings, const LogSink& log,
       const RunOptions& options)
      : dataset_(dataset), pipeline_(calibration, settings, log, options.observer) {}

  void watch_calibration(const Calibration& calibration, const SelfCalibrationSettings& settings) {
    watch_frames_ = settings.frames;
    watch_.emplace(calibration, pipeline_.preprocessor().output_camera(), settings);
  }

  PassEnd run(const RunOptions& options) {
    const FramePreprocessor& preprocessor = pipeline_.preprocessor();
    Reader reader(dataset_.size(), [&](int index) { return prepare(dataset_, preprocessor, index); });
    for (int done = 1; done <= dataset_.size(); ++done) {
      if (must_stop(options)) return PassEnd::kStopped;
      std::optional<Reader::Item> item;
      {
        const StageTimer timer(pipeline_.times(), "wait_for_frame");
        item = reader.next();
      }
      if (!item) break;
      const FrameRecord& frame = process(dataset_, pipeline_, *item);
      if (options.progress) options.progress({done, dataset_.size(), pipeline_.keyframes(), frame});
      if (is_calibration_wrong(frame, done)) return PassEnd::kBetterCalibration;
    }
    return PassEnd::kDone;
  }

  Calibration better_calibration() const { return watch_->better(); }
  SlamResult finish() { return pipeline_.finish(); }

 private:
  bool is_calibration_wrong(const FrameRecord& frame, int done) {
    if (!watch_ || done > watch_frames_ || !frame.is_keyframe) return false;
    const StageTimer timer(pipeline_.times(), "self_calibration");
    return watch_->add(pipeline_.window());
  }

  const Dataset& dataset_;
  Pipeline pipeline_;
  std::optional<SelfCalibration> watch_;
  int watch_frames_ = 0;
};

std::string describe_change(const CameraCalibration& from, const CameraCalibration& to) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "the images contradict the calibration: focal lengths %.1f %.1f instead of %.1f %.1f, distortion "
                "coefficient %.4f instead of %.4f; starting again",
                to.fx, to.fy, from.fx, from.fy, to.distortion[0], from.distortion[0]);
  return text;
}

}  // namespace

SequenceRun run_sequence(const Dataset& dataset, const Settings& settings, const LogSink& log,
                         const RunOptions& options) {
  SequenceRun run;
  run.calibration = dataset.calibration();
  const Clock::time_point start = Clock::now();
  for (run.passes = 1;; ++run.passes) {
    Pass pass(dataset, run.calibration, settings, log, options);
    if (settings.self_calibration.enabled && run.passes < settings.self_calibration.passes) {
      pass.watch_calibration(run.calibration, settings.self_calibration);
    }
    PassEnd end = PassEnd::kDone;
    try {
      end = pass.run(options);
    } catch (const std::exception& error) {
      run.error = error.what();
    }
    if (end == PassEnd::kBetterCalibration) {
      Calibration better = pass.better_calibration();
      log_to(log, LogLevel::kInfo, describe_change(run.calibration.camera, better.camera));
      run.calibration = std::move(better);
      continue;
    }
    run.stopped = end == PassEnd::kStopped;
    run.seconds = milliseconds(start, Clock::now()) / 1e3;
    run.result = pass.finish();
    return run;
  }
}

}  // namespace ldso
