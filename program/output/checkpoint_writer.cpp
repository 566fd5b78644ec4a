#include "output/checkpoint_writer.h"

#include <exception>
#include <utility>

#include "ldso/error.h"
#include "util/out_of_memory.h"

namespace ldso {

CheckpointWriter::CheckpointWriter(OutputFolder& out, RunSummary base, const Dataset& dataset,
                                   std::function<void(const std::string&)> warn)
    : out_(out), base_(std::move(base)), dataset_(dataset), warn_(std::move(warn)) {}

void CheckpointWriter::write(SequenceRun run, std::vector<std::uint8_t> recording) {
  if (is_busy_) return;
  is_busy_ = true;
  RunSummary summary = base_;
  summary.run = std::move(run);
  summary.recording = std::move(recording);
  thread_ = std::jthread([this, summary = std::move(summary)]() mutable {
    write_files(std::move(summary));
    is_busy_ = false;
  });
}

void CheckpointWriter::write_files(RunSummary summary) {
  try {
    collect_results(summary);
    for (const std::string& problem : write_run_files(out_, summary, false)) throw Error(problem);
    write_checkpoint_json(out_, summary, dataset_);
  } catch (const std::exception& error) {
    warn_("a checkpoint could not be written: " + problem_of(error, "writing it"));
  }
}

void CheckpointWriter::close() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace ldso
