#pragma once
// Results of a run that goes on, so that a cut in power or a killed process costs what was computed since, and no more.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "output/run_files.h"

namespace ldso {

/// Writes on a thread of its own: the run waits for copies of its results alone.
class CheckpointWriter {
 public:
  /// `base`: what run.json says of the run but for its results. Nobody else may use `out` before close(); it and
  /// `dataset` must outlive this. `warn` hears, on that thread, why a checkpoint could not be written.
  CheckpointWriter(OutputFolder& out, RunSummary base, const Dataset& dataset,
                   std::function<void(const std::string&)> warn);

  /// The run so far, with its recording. Left out while an earlier one is being written.
  void write(SequenceRun run, std::vector<std::uint8_t> recording);

  /// Waits for the one that is being written.
  void close();

 private:
  void write_files(RunSummary summary);

  OutputFolder& out_;
  RunSummary base_;
  const Dataset& dataset_;
  std::function<void(const std::string&)> warn_;
  std::atomic<bool> is_busy_{false};
  std::jthread thread_;
};

}  // namespace ldso
