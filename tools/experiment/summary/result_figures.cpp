#include "experiment/summary/result_figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/trajectory_picture.h"
#include "experiment/summary/block_plot.h"
#include "ldso/error.h"
#include "ldso/io/trajectory_file.h"

namespace ldso {
namespace {

/// Those of which the papers show curves.
std::vector<const ErrorKind*> curve_kinds(JobMetric metric) {
  if (metric == JobMetric::kTumMono) return error_kinds(metric);
  return {&kAteError};
}

/// The run in the middle by its error; of those without one none.
const JobResult* median_run(std::vector<const JobResult*> jobs, const ErrorKind& kind) {
  std::erase_if(jobs, [&](const JobResult* result) {
    const std::optional<double> error = counted_error(*result, kind);
    return !error || !std::isfinite(*error);
  });
  if (jobs.empty()) return nullptr;
  const auto middle = jobs.begin() + static_cast<std::ptrdiff_t>((jobs.size() - 1) / 2);
  std::nth_element(jobs.begin(), middle, jobs.end(), [&](const JobResult* a, const JobResult* b) {
    const double error_a = *counted_error(*a, kind), error_b = *counted_error(*b, kind);
    return error_a != error_b ? error_a < error_b : a->job.id < b->job.id;
  });
  return *middle;
}

}  // namespace

std::vector<Figure> error_figures(const DatasetResults& dataset, const CumulativePlotOptions& options) {
  const std::string of = dataset.name.empty() ? "" : ", " + dataset.name;
  std::vector<Figure> figures;
  const ErrorKind& main = main_error(dataset.metric);
  figures.push_back({"blocks_" + std::string(main.name) + "_" + dataset.file_name,
                     std::string(main.title) + " of each run" + of, block_plot(dataset, main)});
  for (const ErrorKind* kind : curve_kinds(dataset.metric)) {
    if (!has_any_error(dataset.jobs, *kind)) continue;
    figures.push_back({"curves_" + std::string(kind->name) + "_" + dataset.file_name,
                       std::string(kind->title) + ": number of runs below x" + of,
                       cumulative_plot(dataset, *kind, options)});
  }
  return figures;
}

std::vector<const JobResult*> representative_runs(const DatasetResults& dataset) {
  const bool any_loops =
      std::any_of(dataset.jobs.begin(), dataset.jobs.end(), [](const JobResult* result) { return result->job.loops; });
  const ErrorKind& kind = main_error(dataset.metric);
  std::vector<const JobResult*> runs;
  for (const std::string& sequence : dataset.sequences) {
    for (const std::string& variant : dataset.variants) {
      const auto both = select(dataset.jobs, {sequence, variant, std::nullopt});
      if (both.empty() || (any_loops && !both.front()->job.loops)) continue;
      const JobResult* run = median_run(select(both, {std::nullopt, std::nullopt, false}), kind);
      if (run == nullptr) run = median_run(both, kind);
      if (run != nullptr) runs.push_back(run);
    }
  }
  return runs;
}

Figure trajectory_figure(const std::filesystem::path& job_folder, const JobResult& run, const GroundTruth& truth) {
  if (!truth.problem.empty()) throw Error(truth.problem);
  Figure figure;
  figure.name = "trajectory_" + file_name_of(run.job.id);
  figure.caption = run.job.id;
  const std::string title = run.job.sequence + ", " + run.job.variant + (run.job.reverse ? ", backward" : "");
  const Trajectory after = read_tum_trajectory(job_folder / "trajectory.txt");
  if (run.errors != run.odometry_errors) {
    const Trajectory before = read_tum_trajectory(job_folder / "trajectory_odometry.txt");
    figure.svg = loop_picture(before, after, truth.poses, title);
  } else {
    PictureOptions options;
    options.title = title;
    figure.svg = trajectory_picture(after, truth.poses, evaluate_trajectory(after, truth.poses), options);
  }
  return figure;
}

}  // namespace ldso
