#pragma once
// Two experiments, run by run: what got better or worse.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "experiment/jobs/job_result.h"
#include "experiment/summary/text_table.h"

namespace ldso {

/// One sequence and variant in both.
struct SequenceComparison {
  std::string dataset, sequence, variant;
  JobMetric metric = JobMetric::kAte;
  std::size_t pairs = 0;  ///< Runs that have ended in both, by job id.
  std::size_t failed_a = 0, failed_b = 0;
  double median_a = 0, median_b = 0;  ///< Of the counted errors of the pairs; may be infinite.
  std::optional<double> ratio;        ///< b / a: above 1, b is worse. None if a median is infinite.
  double p = 1;  ///< Wilcoxon signed-rank test over the pairs, two-sided; pairs that repeat another exactly count once.
};

struct ExperimentComparison {
  std::vector<SequenceComparison> sequences;
  double ratio = 1;  ///< Geometric mean of the ratios.
  double p = 1;      ///< As above, over all pairs.
  std::size_t pairs = 0;
  std::vector<std::string> only_in_a, only_in_b;  ///< Ids of jobs that have ended in one alone: the other has no such
                                                  ///< job, or it is pending or not measured.
  std::vector<std::string> newly_failed;          ///< Ids: finished in a, failed in b.
  std::vector<std::string> recovered;             ///< The reverse.
};

/// Pairs by job id, by the error that ranks the runs. Throws ldso::Error if no job has ended in both, or a job is
/// judged by different metrics.
ExperimentComparison compare_experiments(const std::vector<JobResult>& a, const std::vector<JobResult>& b);

/// Allowed loss of b against a [%].
struct LossLimits {
  std::optional<double> overall;   ///< Of the geometric mean; a run that newly failed is a loss, too.
  std::optional<double> sequence;  ///< Of each sequence and variant.
};

/// What is past the limits, a line each; empty: nothing.
std::vector<std::string> losses(const ExperimentComparison& comparison, const LossLimits& limits);

/// A row a sequence and variant, with a verdict: "better" or "worse" for differences of more than 1 %, with "(p <
/// 0.05)" where chance is unlikely.
TextTable comparison_table(const ExperimentComparison& comparison);

}  // namespace ldso
