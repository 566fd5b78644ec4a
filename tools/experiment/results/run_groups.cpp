#include "experiment/results/run_groups.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "experiment/jobs/job_file.h"
#include "util/median.h"

namespace ldso {
namespace {

template <class Member>
std::vector<std::string> names_of(const std::vector<const JobResult*>& jobs, Member member) {
  std::set<std::string> names;
  for (const JobResult* result : jobs) names.insert(result->job.*member);
  return {names.begin(), names.end()};
}

}  // namespace

std::vector<DatasetResults> group_by_dataset(const std::vector<JobResult>& results) {
  std::map<std::pair<std::string, JobMetric>, DatasetResults> groups;
  std::map<std::string, std::set<JobMetric>> metrics;
  for (const JobResult& result : results) {
    DatasetResults& group = groups[{result.job.dataset, result.job.metric}];
    group.name = result.job.dataset;
    group.metric = result.job.metric;
    group.jobs.push_back(&result);
    metrics[group.name].insert(group.metric);
  }
  std::vector<DatasetResults> datasets;
  for (auto& [key, group] : groups) {
    group.sequences = names_of(group.jobs, &ExperimentJob::sequence);
    group.variants = names_of(group.jobs, &ExperimentJob::variant);
    group.file_name = file_name_of(group.name.empty() ? "sequences" : group.name);
    if (metrics[group.name].size() > 1) group.file_name.append("_").append(to_string(group.metric));
    datasets.push_back(std::move(group));
  }
  return datasets;
}

std::vector<const JobResult*> select(const std::vector<const JobResult*>& jobs, const JobFilter& filter) {
  std::vector<const JobResult*> selected;
  for (const JobResult* result : jobs) {
    const ExperimentJob& job = result->job;
    if (filter.sequence && job.sequence != *filter.sequence) continue;
    if (filter.variant && job.variant != *filter.variant) continue;
    if (filter.reverse && job.reverse != *filter.reverse) continue;
    selected.push_back(result);
  }
  return selected;
}

std::optional<double> GroupErrors::median() const {
  if (values.empty()) return std::nullopt;
  return median_of(values);
}

GroupErrors collect_errors(const std::vector<const JobResult*>& jobs, const ErrorKind& kind, Trajectories which) {
  GroupErrors errors;
  for (const JobResult* result : jobs) {
    if (result->state == RunState::kPending) ++errors.pending;
    if (result->state == RunState::kFailed) ++errors.failed;
    if (const std::optional<double> error = counted_error(*result, kind, which)) {
      errors.values.push_back(*error);
    } else if (result->state == RunState::kFinished) {
      ++errors.unmeasured;
    }
  }
  std::sort(errors.values.begin(), errors.values.end());
  return errors;
}

bool has_any_error(const std::vector<const JobResult*>& jobs, const ErrorKind& kind) {
  return std::any_of(jobs.begin(), jobs.end(), [&](const JobResult* result) {
    const std::optional<double> error = counted_error(*result, kind);
    return error && std::isfinite(*error);
  });
}

bool any_changed_by_loops(const std::vector<const JobResult*>& jobs, const ErrorKind& kind) {
  return std::any_of(jobs.begin(), jobs.end(), [&](const JobResult* result) {
    return result->state == RunState::kFinished &&
           counted_error(*result, kind) != counted_error(*result, kind, Trajectories::kBeforeLoops);
  });
}

std::string file_name_of(const std::string& name) {
  std::string file_name;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
    file_name += plain ? c : '_';
  }
  return file_name;
}

}  // namespace ldso
