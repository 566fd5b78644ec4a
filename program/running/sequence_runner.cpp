#include "running/sequence_runner.h"

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "io/images/prefetching_reader.h"
#include "running/ready_frame.h"
#include "slam/calibration_watch.h"
#include "util/log.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

using Reader = PrefetchingReader<ReadyFrame>;

const FrameRecord& process(const Dataset& dataset, Pipeline& pipeline, const Reader::Item& item) {
  if (!item.value) return pipeline.skip(item.index, dataset.timestamp(item.index), item.error);
  return feed(pipeline, *item.value);
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
    watch_.emplace(calibration, settings, pipeline_);
  }

  PassEnd run(const RunOptions& options) {
    const FramePreprocessor& preprocessor = pipeline_.preprocessor();
    Reader reader(dataset_.size(),
                  [&](int index) { return make_ready([&] { return dataset_.read(index); }, preprocessor); });
    for (int done = 1; done <= dataset_.size(); ++done) {
      if (must_stop(options)) return PassEnd::kStopped;
      std::optional<Reader::Item> item;
      {
        const StageTimer timer(pipeline_.times(), "wait_for_frame");
        item = reader.next();
      }
      if (!item) break;
      const FrameRecord& frame = process(dataset_, pipeline_, *item);
      if (options.progress) options.progress({done, dataset_.size(), pipeline_.keyframes(), frame, 0});
      if (watch_ && watch_->is_wrong(frame, done, pipeline_)) return PassEnd::kBetterCalibration;
    }
    return PassEnd::kDone;
  }

  Calibration better_calibration() const { return watch_->better(); }
  SlamResult finish() { return pipeline_.finish(); }

 private:
  const Dataset& dataset_;
  Pipeline pipeline_;
  std::optional<CalibrationWatch> watch_;
};

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
      log_to(log, LogLevel::kInfo, describe_change(run.calibration.camera, better.camera) + "; starting again");
      run.calibration = std::move(better);
      continue;
    }
    run.stopped = end == PassEnd::kStopped;
    run.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    run.result = pass.finish();
    return run;
  }
}

}  // namespace ldso
