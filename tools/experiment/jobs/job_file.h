#pragma once
// job.json: what a job of an experiment is, kept in its folder.

#include <filesystem>
#include <string>

#include "experiment/jobs/job.h"

namespace ldso {

/// "ate", "tum_mono".
std::string to_string(JobMetric metric);
/// The reverse; throws ldso::Error for any other name.
JobMetric parse_job_metric(const std::string& name);

/// Writes job.json into the folder, which is created. It is there as a whole or not at all.
/// Throws ldso::Error if it cannot be written.
void write_job(const std::filesystem::path& folder, const ExperimentJob& job);

/// Whether read_job() can read one there.
bool has_job(const std::filesystem::path& folder);

/// Throws ldso::Error naming the file if there is none, it is damaged, or a member is missing or of another type.
ExperimentJob read_job(const std::filesystem::path& folder);

}  // namespace ldso
