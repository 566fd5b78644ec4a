#pragma once
// What `ldso eval` says: the result as a table for people and as JSON for programs.

#include <string>
#include <string_view>

#include "evaluation/trajectory_evaluation.h"

namespace ldso {

/// Which figures are wanted.
enum class ReportMetric {
  kAll,      ///< All that exist.
  kAte,      ///< Absolute and relative errors.
  kTumMono,  ///< e_align, e_t, e_r, e_s and what belongs to them.
  kKitti,    ///< t_rel and r_rel, over all sub-paths and for each length.
};

/// "all", "ate", "tum-mono", "kitti"; throws ldso::Error for any other name.
ReportMetric parse_report_metric(const std::string& name);

/// Throws ldso::Error saying why, if a metric that was asked for does not exist for this pair of trajectories.
void require_metric(const EvaluationResult& result, ReportMetric metric);

/// Several lines, each ending in a newline; every figure on a line of its own that begins with its name. What does not
/// exist for this pair of trajectories is left out.
std::string result_table(const EvaluationResult& result, ReportMetric metric = ReportMetric::kAll);

/// By which a file of result_json() is recognized.
inline constexpr std::string_view kResultJsonBeginning = "{\n  \"pairs\":";

/// A JSON object, indented; figures that do not exist for this pair of trajectories are null.
std::string result_json(const EvaluationResult& result);

}  // namespace ldso
