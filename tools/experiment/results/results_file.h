#pragma once
// results.json and results.csv: one row a job, with all its figures, without trajectories and without paths: what is
// worth keeping of an experiment.

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/jobs/job_result.h"

namespace ldso {

/// An array of objects. Figures that do not exist are missing.
std::string results_json(const std::vector<JobResult>& jobs);

/// A head line and a line a job (RFC 4180). Figures that do not exist are empty. Times are in the columns `<stage>_ms`,
/// means over the calls of the stage.
std::string results_csv(const std::vector<JobResult>& jobs);

/// Reads a file of either kind, told by its extension. A csv file may lack columns of figures and have others; calls of
/// stages are not in it. Throws ldso::Error naming file and row.
std::vector<JobResult> read_results(const std::filesystem::path& path);

}  // namespace ldso
