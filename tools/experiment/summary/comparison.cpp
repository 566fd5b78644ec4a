#include "experiment/summary/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "experiment/results/signed_rank.h"
#include "ldso/error.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

constexpr double kSignificance = 0.05;

constexpr double kSameRatio = 1.01;  ///< Smaller differences are called the same.

/// Errors of a run in both experiments; failed ones are infinite.
struct ErrorPair {
  double a = 0, b = 0;
  bool operator<(const ErrorPair& other) const { return std::tie(a, b) < std::tie(other.a, other.b); }
};

using Group = std::tuple<std::string, JobMetric, std::string, std::string>;  ///< Data set, metric, sequence, variant.

/// log(b / a): ratios, because sequences differ in size. Zero where both failed or both are perfect.
double log_ratio(const ErrorPair& pair) {
  if (pair.a == pair.b) return 0;
  return std::log(pair.b) - std::log(pair.a);
}

/// Runs are deterministic: a repetition that comes out exactly as another says nothing new.
std::vector<double> distinct_log_ratios(const std::vector<ErrorPair>& pairs) {
  const std::set<ErrorPair> distinct(pairs.begin(), pairs.end());
  std::vector<double> ratios;
  for (const ErrorPair& pair : distinct) ratios.push_back(log_ratio(pair));
  return ratios;
}

SequenceComparison compare_group(const Group& group, const std::vector<ErrorPair>& pairs) {
  SequenceComparison result;
  std::tie(result.dataset, result.metric, result.sequence, result.variant) = group;
  result.pairs = pairs.size();
  std::vector<double> a, b;
  for (const ErrorPair& pair : pairs) {
    a.push_back(pair.a);
    b.push_back(pair.b);
    if (std::isinf(pair.a)) ++result.failed_a;
    if (std::isinf(pair.b)) ++result.failed_b;
  }
  result.median_a = median_of(std::move(a));
  result.median_b = median_of(std::move(b));
  const bool both = std::isfinite(result.median_a) && std::isfinite(result.median_b);
  if (both && result.median_a == result.median_b) {
    result.ratio = 1;
  } else if (both && result.median_a > 0) {
    result.ratio = result.median_b / result.median_a;
  }
  result.p = signed_rank_test(distinct_log_ratios(pairs)).p;
  return result;
}

std::map<std::string, const JobResult*> ended_by_id(const std::vector<JobResult>& jobs) {
  std::map<std::string, const JobResult*> by_id;
  for (const JobResult& result : jobs) {
    if (!counted_error(result, main_error(result.job.metric))) continue;
    if (!by_id.emplace(result.job.id, &result).second) {
      throw Error("job " + result.job.id, "is there twice in the same experiment", "");
    }
  }
  return by_id;
}

ErrorPair pair_of(const JobResult& a, const JobResult& b) {
  if (a.job.metric != b.job.metric) {
    throw Error("job " + a.job.id, "is judged by different metrics in the two experiments", "compare like with like");
  }
  const ErrorKind& kind = main_error(a.job.metric);
  return {*counted_error(a, kind), *counted_error(b, kind)};
}

void compare_overall(const std::map<Group, std::vector<ErrorPair>>& groups, ExperimentComparison& comparison) {
  double sum = 0;
  std::size_t count = 0;
  for (const SequenceComparison& sequence : comparison.sequences) {
    if (!sequence.ratio || *sequence.ratio <= 0) continue;
    sum += std::log(*sequence.ratio);
    ++count;
  }
  if (count > 0) comparison.ratio = std::exp(sum / static_cast<double>(count));
  std::vector<double> ratios;
  for (const auto& [group, pairs] : groups) {
    comparison.pairs += pairs.size();
    for (const double ratio : distinct_log_ratios(pairs)) ratios.push_back(ratio);
  }
  comparison.p = signed_rank_test(ratios).p;
}

std::string percent(double ratio) { return format_text("%+.1f %%", 100 * (ratio - 1)); }

std::string verdict(const SequenceComparison& sequence) {
  const bool a_failed = std::isinf(sequence.median_a), b_failed = std::isinf(sequence.median_b);
  if (a_failed && b_failed) return "fails in both";
  // Without a ratio A was perfect and B is not.
  const double ratio = sequence.ratio.value_or(std::numeric_limits<double>::infinity());
  const bool is_worse = b_failed || (!a_failed && ratio > kSameRatio);
  const bool is_better = a_failed || ratio < 1 / kSameRatio;
  if (!is_worse && !is_better) return "same";
  return std::string(is_worse ? "worse" : "better") + (sequence.p < kSignificance ? " (p < 0.05)" : "");
}

std::string p_text(double p) { return format_text(p < 0.0001 ? "%.1e" : "%.4f", p); }

std::string count_text(std::size_t a, std::size_t b) { return std::to_string(a) + " -> " + std::to_string(b); }

}  // namespace

ExperimentComparison compare_experiments(const std::vector<JobResult>& a, const std::vector<JobResult>& b) {
  const auto jobs_a = ended_by_id(a), jobs_b = ended_by_id(b);
  ExperimentComparison comparison;
  std::map<Group, std::vector<ErrorPair>> groups;
  for (const auto& [id, result] : jobs_a) {
    const auto other = jobs_b.find(id);
    if (other == jobs_b.end()) {
      comparison.only_in_a.push_back(id);
      continue;
    }
    const ErrorPair pair = pair_of(*result, *other->second);
    const ExperimentJob& job = result->job;
    groups[{job.dataset, job.metric, job.sequence, job.variant}].push_back(pair);
    if (std::isfinite(pair.a) && std::isinf(pair.b)) comparison.newly_failed.push_back(id);
    if (std::isinf(pair.a) && std::isfinite(pair.b)) comparison.recovered.push_back(id);
  }
  for (const auto& [id, result] : jobs_b) {
    if (!jobs_a.contains(id)) comparison.only_in_b.push_back(id);
  }
  if (groups.empty()) {
    throw Error("comparison", "no job has ended in both experiments",
                "jobs are paired by their ids: both must come from the same plan");
  }
  for (const auto& [group, pairs] : groups) comparison.sequences.push_back(compare_group(group, pairs));
  compare_overall(groups, comparison);
  return comparison;
}

std::vector<std::string> losses(const ExperimentComparison& comparison, const LossLimits& limits) {
  std::vector<std::string> found;
  if (limits.overall) {
    if (comparison.ratio > 1 + *limits.overall / 100) found.push_back("overall " + percent(comparison.ratio));
    for (const std::string& id : comparison.newly_failed) found.push_back(id + " fails now");
  }
  for (const SequenceComparison& sequence : comparison.sequences) {
    if (!limits.sequence) break;
    const std::string name = sequence.sequence + ", " + sequence.variant;
    if (std::isfinite(sequence.median_a) && std::isinf(sequence.median_b)) {
      found.push_back(name + ": fails now in half of the runs or more");
    } else if (sequence.ratio && *sequence.ratio > 1 + *limits.sequence / 100) {
      found.push_back(name + ": " + percent(*sequence.ratio));
    }
  }
  return found;
}

TextTable comparison_table(const ExperimentComparison& comparison) {
  TextTable table;
  table.name = "comparison";
  table.caption = "Medians of the errors [m] of A and B over the runs";
  table.head = {"sequence", "variant", "runs", "failed", "error", "A", "B", "change", "p", "verdict"};
  for (const SequenceComparison& s : comparison.sequences) {
    const std::string name = s.dataset.empty() ? s.sequence : s.dataset + "/" + s.sequence;
    table.rows.push_back({{name},
                          {s.variant},
                          {std::to_string(s.pairs)},
                          {count_text(s.failed_a, s.failed_b)},
                          {std::string(main_error(s.metric).symbol)},
                          {table_number(s.median_a)},
                          {table_number(s.median_b)},
                          {s.ratio ? percent(*s.ratio) : "-"},
                          {p_text(s.p)},
                          {verdict(s)}});
  }
  return table;
}

}  // namespace ldso
