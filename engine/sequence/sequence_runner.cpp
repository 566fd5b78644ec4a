#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "ldso/error.h"
#include "ldso/sequence_run.h"
#include "sequence/calibration_course.h"
#include "sequence/checkpoint_clock.h"
#include "sequence/ready_frame.h"
#include "util/format_text.h"
#include "util/log.h"
#include "util/out_of_memory.h"
#include "util/prefetching_reader.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

using Reader = PrefetchingReader<ReadyFrame>;

const FrameRecord& process(const FrameSource& source, Pipeline& pipeline, const Reader::Item& item) {
  if (!item.value) return pipeline.skip(item.index, source.timestamp(item.index), item.error);
  return feed(pipeline, *item.value);
}

bool must_stop(const RunOptions& options) { return options.stop != nullptr && options.stop->load(); }

/// What ends a pass over the sequence.
enum class PassEnd { kDone, kStopped, kBeginsAnew };

/// One pass over the sequence with one calibration.
class Pass {
 public:
  /// `run`: all but the result, with the calibration of this pass. It must outlive this.
  Pass(const FrameSource& source, SequenceRun& run, const Settings& settings, const LogSink& log,
       const RunOptions& options)
      : source_(source), run_(run), log_(log), pipeline_(run.calibration, settings, log, options.observer) {}

  /// `course` hears of the first frames and says whether to go on. It must outlive this.
  void watch_for(CalibrationCourse& course, const SelfCalibrationSettings& settings) {
    course_ = &course;
    watch_.emplace(course.search().calibration(), settings, pipeline_);
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
    return watch_->is_over() || (is_new && course_->search().is_clear(watch_->findings()));
  }

  /// Once, when that is so.
  bool begins_anew() {
    const CalibrationFindings findings = watch_->findings();
    log_to(log_, LogLevel::kInfo,
           format_text("%zu windows are off the calibration by %.1f standard deviations, off each other by %.1f",
                       findings.fits.size(), findings.deviations, std::sqrt(findings.disagreement)));
    const CalibrationSearch& search = course_->search();
    const bool anew = course_->search().begins_anew(findings);
    watch_.reset();
    pipeline_.postpone_revision(false);
    course_->note(run_);
    if (search.is_corrected()) log_to(log_, LogLevel::kWarning, "the better calibration stands: " + search.proof());
    return anew;
  }

  const FrameSource& source_;
  SequenceRun& run_;
  const LogSink& log_;
  Pipeline pipeline_;
  int done_ = 0;
  CalibrationCourse* course_ = nullptr;
  std::optional<CalibrationWatch> watch_;
};

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
  CalibrationCourse course(source, settings, log, options.stop);
  for (run.passes = 1;; ++run.passes) {
    run.calibration = course.calibration();
    Pass pass(source, run, settings, log, options);
    if (course.is_open()) pass.watch_for(course, settings.self_calibration);
    const PassEnd end = run_pass(pass, options, checkpoints, run);
    if (end == PassEnd::kBeginsAnew) {
      course.begin_anew();
      continue;
    }
    course.note(run);
    run.stopped = end == PassEnd::kStopped;
    run.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    run.result = pass.finish();
    course.note_found_camera(run);
    return run;
  }
}

}  // namespace ldso
