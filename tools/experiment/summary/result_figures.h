#pragma once
// Which figures an experiment gets.

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/results/experiment_results.h"
#include "experiment/results/run_groups.h"
#include "experiment/summary/cumulative_plot.h"

namespace ldso {

struct Figure {
  std::string name;  ///< Of its file, without extension.
  std::string caption;
  std::string svg;
};

/// Block plot of the error that ranks the runs, and cumulative curves of all errors of the metric. Only those of which
/// there is a value.
std::vector<Figure> error_figures(const DatasetResults& dataset, const CumulativePlotOptions& options);

/// The runs whose trajectories are drawn: of each sequence and variant with loops (of each variant, if there is none
/// with loops) the one with the median error, forward if there are both directions.
std::vector<const JobResult*> representative_runs(const DatasetResults& dataset);

/// The trajectory of the run over ground truth; before and after loop closing if that has moved it. Throws ldso::Error
/// if the files of the run cannot be read.
Figure trajectory_figure(const std::filesystem::path& job_folder, const JobResult& run, const GroundTruth& truth);

}  // namespace ldso
