#pragma once
// How far an experiment is.

#include <string>

#include "experiment/jobs/job_runner.h"
#include "terminal/progress_bar.h"

namespace ldso {

/// "12/60 done, 2 running, 1 failed, 5 min left"
std::string progress_text(const RunnerProgress& progress);

class ExperimentProgress {
 public:
  /// `quiet`: warnings only.
  explicit ExperimentProgress(bool quiet) : bar_(quiet, 1) {}

  void update(const RunnerProgress& progress);
  void failed(const ExperimentJob& job, const std::string& reason);

 private:
  ProgressBar bar_;
};

}  // namespace ldso
