#pragma once
// The results of all jobs of an experiment, from what lies in its folder at this moment.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "experiment/jobs/job_result.h"
#include "experiment/results/run_errors.h"

namespace ldso {

struct ExperimentResults {
  std::vector<JobResult> jobs;  ///< In order of dataset, sequence, variant, direction and repetition.
  std::vector<std::string> warnings;
};

/// Folders with a job.json below `<experiment>/jobs`, in order of their paths. Throws ldso::Error if there is no such
/// folder.
std::vector<std::filesystem::path> find_job_folders(const std::filesystem::path& experiment);

/// The ground truths that jobs share, each loaded once.
class GroundTruths {
 public:
  /// Loads those of all jobs, several at a time.
  void load(const std::vector<const ExperimentJob*>& jobs, int threads);
  /// That of a job given to load().
  const GroundTruth& of(const ExperimentJob& job) const;

 private:
  std::map<std::string, GroundTruth> truths_;
};

/// Reads what is there; runs may go on meanwhile. A job that cannot be read is left out with a warning. Ground truth
/// and trajectories that cannot be read give a warning, too; the figures in run.json are taken then.
ExperimentResults collect_results(const std::filesystem::path& experiment, int threads);

}  // namespace ldso
