#include "output/run_results.h"

#include <exception>
#include <utility>

#include "imagery/point_colors.h"
#include "report/report_page.h"
#include "results/loop_pictures.h"
#include "util/out_of_memory.h"
#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

/// Frames that cannot be read again cost their pictures only.
void draw_loops(OutputFolder& out, RunSummary& summary, const Dataset& dataset, bool are_wanted,
                const std::function<void(const std::string&)>& warn) {
  if (out.owns(kLoopPictureFolder)) remove_loop_pictures(out.path());
  out.remove(kLoopPictureFolder);
  if (!are_wanted) return;
  out.file(kLoopPictureFolder);
  for (std::string& warning : write_loop_pictures(out.path(), summary.run.result.loops, dataset,
                                                  summary.run.calibration, summary.settings.photometry)) {
    if (warn) warn(warning);
    summary.warnings.push_back(std::move(warning));
  }
}

/// The viewer shows points in the colours of their images, if there are any, and lengths in metres, if they are known.
void finish_recording(OutputFolder& out, RunSummary& summary, const Dataset& dataset,
                      const std::function<void(const std::string&)>& warn) {
  const SequenceRun& run = summary.run;
  const bool is_metric = summary.scale && summary.scale->problem.empty();
  const double metres_per_unit = is_metric ? summary.scale->metres_per_unit : 1;
  Bytes finished = is_metric ? with_scale(summary.recording, metres_per_unit) : summary.recording;
  if (!run.live) {  // Of a live run the frames are gone.
    finished = colored_recording(finished, dataset, run.calibration, run.result.camera, summary.trajectory,
                                 metres_per_unit, [&](const std::string& text) {
                                   if (warn) warn(text);
                                   summary.warnings.push_back(text);
                                 });
  }
  if (finished == summary.recording) return;
  summary.recording = std::move(finished);
  write_recording(out.file(kRecordingName), summary.recording);
}

/// Does it; what it throws becomes a problem of the results, and costs nothing else.
template <class Action>
void keep_going(const Action& action, std::vector<std::string>& problems) {
  try {
    action();
  } catch (const std::exception& error) {
    problems.push_back(problem_of(error, "writing results"));
  }
}

}  // namespace

std::vector<std::string> write_run_results(OutputFolder& out, RunSummary& summary, const Dataset& dataset,
                                           const RunResultsOptions& options,
                                           const std::function<void(const std::string&)>& warn) {
  collect_results(summary);
  summary.evaluation = evaluate_run(summary.trajectory, dataset);
  if (summary.is_corrected()) summary.odometry_evaluation = evaluate_run(summary.odometry_trajectory, dataset);
  // What was computed is safe before pictures read frames again.
  std::vector<std::string> problems = write_run_files(out, summary, options.kitti);
  keep_going([&] { finish_recording(out, summary, dataset, warn); }, problems);
  keep_going([&] { draw_loops(out, summary, dataset, options.loop_pictures, warn); }, problems);
  if (options.report) keep_going([&] { write_report(out.file(kReportName), summary, dataset); }, problems);
  if (!problems.empty() && summary.run.error.empty()) summary.run.error = "results are missing: " + problems.front();
  keep_going([&] { write_run_json(out, summary, dataset); }, problems);
  return problems;
}

}  // namespace ldso
