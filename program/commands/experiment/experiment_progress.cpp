#include "commands/experiment/experiment_progress.h"

#include "experiment/jobs/time_left.h"

namespace ldso {

std::string progress_text(const RunnerProgress& progress) {
  const int done = progress.finished + progress.failed;
  std::string text = std::to_string(done) + "/" + std::to_string(progress.count) + " done, " +
                     std::to_string(progress.running) + " running";
  if (progress.elsewhere > 0) text += ", " + std::to_string(progress.elsewhere) + " elsewhere";
  text += ", " + std::to_string(progress.failed) + " failed";
  if (progress.seconds_left && done < progress.count)
    text += ", " + readable_duration(*progress.seconds_left) + " left";
  return text;
}

void ExperimentProgress::update(const RunnerProgress& progress) {
  bar_.update(progress.finished + progress.failed, progress.count, progress_text(progress));
}

void ExperimentProgress::failed(const ExperimentJob& job, const std::string& reason) {
  bar_.message(LogLevel::kInfo, job.id + ": failed: " + reason);
}

}  // namespace ldso
