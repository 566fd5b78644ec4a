#pragma once
// Results in groups, as rows and columns of figures and tables show them.

#include <optional>
#include <string>
#include <vector>

#include "experiment/jobs/job_result.h"

namespace ldso {

/// Jobs whose sequences share figures: the same data set, judged by the same metric.
struct DatasetResults {
  std::string name;       ///< Of the data set; may be empty.
  std::string file_name;  ///< The same for file names; together with the metric if there are several.
  JobMetric metric = JobMetric::kAte;
  std::vector<const JobResult*> jobs;
  std::vector<std::string> sequences;  ///< In order of their names.
  std::vector<std::string> variants;
};

/// In order of name and metric. The results must outlive it.
std::vector<DatasetResults> group_by_dataset(const std::vector<JobResult>& results);

/// Those jobs that fit; what is not given fits all.
struct JobFilter {
  std::optional<std::string> sequence, variant;
  std::optional<bool> reverse;
};
std::vector<const JobResult*> select(const std::vector<const JobResult*>& jobs, const JobFilter& filter);

/// How the runs of a group came out in one error.
struct GroupErrors {
  std::vector<double> values;  ///< Counted errors (see counted_error), failed runs as infinity; sorted.
  std::size_t failed = 0;
  std::size_t pending = 0;
  std::size_t unmeasured = 0;  ///< Finished without this error.
  /// Infinite if half of the runs failed; nothing without values.
  std::optional<double> median() const;
};
GroupErrors collect_errors(const std::vector<const JobResult*>& jobs, const ErrorKind& kind,
                           Trajectories which = Trajectories::kFinal);

/// Whether any run has finished with this error.
bool has_any_error(const std::vector<const JobResult*>& jobs, const ErrorKind& kind);

/// Whether loop closing has moved the trajectory of any of the runs.
bool any_changed_by_loops(const std::vector<const JobResult*>& jobs, const ErrorKind& kind);

/// Letters, digits, '.', '-' and '_' of a name, anything else as '_': for file names.
std::string file_name_of(const std::string& name);

}  // namespace ldso
