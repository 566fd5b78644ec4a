#pragma once
// The tables of an experiment: errors by sequence beside published ones (the paper's Table I), the runtime of the
// strategies (Table II), summaries.

#include <vector>

#include "experiment/results/run_groups.h"
#include "experiment/summary/published.h"
#include "experiment/summary/text_table.h"

namespace ldso {

/// A row a sequence: the median of each variant and direction (before and after loop closing where that makes a
/// difference), then what others have published; the best of each row is marked. Nothing is there without any value.
std::optional<TextTable> error_table(const DatasetResults& dataset, const ErrorKind& kind,
                                     const std::vector<PublishedResults>& published);

/// A row a variant and direction: runs, failed ones, medians over all runs of all sequences.
TextTable summary_table(const DatasetResults& dataset);

/// A row a variant: mean times of selection and of a keyframe over all keyframes, of tracking over all frames, medians
/// of frames/s and memory over runs. The published times of selection beside them.
TextTable runtime_table(const std::vector<JobResult>& results, const std::vector<PublishedResults>& published);

/// Jobs that failed, could not be measured or are pending for an odd reason, and why.
TextTable problem_table(const std::vector<JobResult>& results);

}  // namespace ldso
