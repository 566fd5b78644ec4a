#include "slam/sequence_runner.h"

#include <chrono>
#include <exception>
#include <memory>

#include "io/prefetching_reader.h"

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

void run_frames(const Dataset& dataset, Pipeline& pipeline, const RunOptions& options, SequenceRun& run) {
  const FramePreprocessor& preprocessor = pipeline.preprocessor();
  Reader reader(dataset.size(), [&](int index) { return prepare(dataset, preprocessor, index); });
  for (int done = 1; done <= dataset.size(); ++done) {
    if (must_stop(options)) {
      run.stopped = true;
      return;
    }
    std::optional<Reader::Item> item;
    {
      const StageTimer timer(pipeline.times(), "wait_for_frame");
      item = reader.next();
    }
    if (!item) return;
    const FrameRecord& frame = process(dataset, pipeline, *item);
    if (options.progress) options.progress({done, dataset.size(), pipeline.keyframes(), frame});
  }
}

}  // namespace

SequenceRun run_sequence(const Dataset& dataset, Pipeline& pipeline, const RunOptions& options) {
  SequenceRun run;
  const Clock::time_point start = Clock::now();
  try {
    run_frames(dataset, pipeline, options, run);
  } catch (const std::exception& error) {
    run.error = error.what();
  }
  run.seconds = milliseconds(start, Clock::now()) / 1e3;
  run.result = pipeline.finish();
  return run;
}

}  // namespace ldso
