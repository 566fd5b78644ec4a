#include "commands/commands.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/doubts.h"
#include "evaluation/report.h"
#include "evaluation/trajectory_evaluation.h"
#include "evaluation/trajectory_picture.h"
#include "evaluation/trajectory_source.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "terminal/option_checks.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct EvalArguments {
  fs::path estimate, truth;
  std::optional<fs::path> times, json, picture;
  std::string align = "sim3", metric = "all", title;
  EvaluationOptions options;
};

void add_options(CLI::App& command, EvalArguments& a) {
  command.add_option("estimate", a.estimate, "Estimated trajectory (TUM or KITTI format)")->required();
  command
      .add_option("groundtruth", a.truth,
                  "True trajectory (TUM, KITTI or EuRoC format), or a sequence folder that carries one")
      ->required();
  command.add_option("--align", a.align, "Alignment of the estimate before it is compared")
      ->check(CLI::IsMember({"se3", "sim3", "scale", "none"}))
      ->capture_default_str();
  command
      .add_option("--metric", a.metric,
                  "Figures to print; tum-mono: drift from the start to the end segment, kitti: drift per distance")
      ->check(CLI::IsMember({"all", "ate", "tum-mono", "kitti"}))
      ->capture_default_str();
  command.add_option("--max-diff", a.options.max_time_difference, "Largest time difference of paired poses [s]")
      ->check(number_from_zero())
      ->capture_default_str();
  command.add_option("--delta", a.options.relative.delta, "Length of the motions of the relative error [poses]")
      ->check(positive_number())
      ->capture_default_str();
  command.add_flag("--all-pairs", a.options.relative.all_pairs, "Let the motions of the relative error overlap");
  command.add_option("--times", a.times, "Times of KITTI poses [s], one a line");
  command.add_option("--json", a.json, "Write all figures to this file");
  command.add_option("--picture", a.picture, "Draw both trajectories into this SVG file");
  command.add_option("--title", a.title, "Title of the picture");
}

/// Found out before anything is computed.
void check_outputs(const EvalArguments& a) {
  if (a.json) refuse_other_file(*a.json, {kResultJsonBeginning}, "a file of figures that ldso wrote");
  if (a.picture) refuse_other_file(*a.picture, {"<svg "}, "an SVG picture");
}

/// Files without times can only be compared pose by pose, and only with another that has as many.
bool must_pair_by_index(const LoadedTrajectory& estimate, const LoadedTrajectory& truth, const EvalArguments& a) {
  if (estimate.has_times && truth.has_times) return false;
  if (estimate.poses.size() == truth.poses.size()) return true;
  throw Error((estimate.has_times ? a.truth : a.estimate).string(),
              "its poses have no time stamps, and their number (estimate " + std::to_string(estimate.poses.size()) +
                  ", ground truth " + std::to_string(truth.poses.size()) + ") differs",
              "give the times of the KITTI poses by --times FILE");
}

/// Beside the table, which other programs may read.
void warn(const std::vector<std::string>& doubts) {
  for (const std::string& doubt : doubts) std::cerr << "warning: " << doubt << "\n";
}

void run_eval(const EvalArguments& a) {
  check_outputs(a);
  const LoadedTrajectory estimate = load_trajectory(a.estimate, a.times);
  const LoadedTrajectory truth = load_trajectory(a.truth, a.times);
  EvaluationOptions options = a.options;
  options.alignment = parse_alignment_mode(a.align);
  options.pair_by_index = must_pair_by_index(estimate, truth, a);
  // Before what may fail for this very reason.
  if (!options.pair_by_index) {
    warn(doubts_about_times(estimate.poses, a.estimate.string()));
    warn(doubts_about_times(truth.poses, a.truth.string()));
  }
  const EvaluationResult result = evaluate_trajectory(estimate.poses, truth.poses, options);
  warn(doubts_about_pairs(estimate.poses, truth.poses, result, options));
  const ReportMetric metric = parse_report_metric(a.metric);
  require_metric(result, metric);

  std::cout << "estimate      " << a.estimate.string() << " (" << estimate.description << ")\n"
            << "ground truth  " << a.truth.string() << " (" << truth.description << ")\n"
            << result_table(result, metric);
  if (a.json) write_file(*a.json, result_json(result));
  if (a.picture) {
    PictureOptions picture;
    picture.title = a.title;
    picture.has_times = !options.pair_by_index;
    write_trajectory_picture(*a.picture, estimate.poses, truth.poses, result, picture);
  }
}

}  // namespace

void add_eval_command(CLI::App& app) {
  auto arguments = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Compare a trajectory with the ground truth");
  add_options(*command, *arguments);
  command->callback([arguments] { run_eval(*arguments); });
}

}  // namespace ldso
