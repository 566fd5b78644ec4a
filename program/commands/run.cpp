#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/camera_stream.h"
#include "commands/commands.h"
#include "commands/live_truth.h"
#include "ldso/error.h"
#include "ldso/io/settings_file.h"
#include "ldso/sequence_run.h"
#include "output/checkpoint_writer.h"
#include "output/run_as_job.h"
#include "output/run_files.h"
#include "output/run_results.h"
#include "results/run_report.h"
#include "running/live_runner.h"
#include "scaling/metric_scale.h"
#include "slam/scaled_result.h"
#include "terminal/browser.h"
#include "terminal/dataset_options.h"
#include "terminal/doctor_hint.h"
#include "terminal/interrupt.h"
#include "terminal/option_checks.h"
#include "terminal/progress_display.h"
#include "terminal/scale_options.h"
#include "viewer/live_run.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  fs::path sequence, out;
  DatasetOptions dataset;
  ScaleRequest scale;
  std::optional<fs::path> config, vocabulary;
  std::optional<int> threads;
  std::optional<std::string> view;
  std::vector<std::string> set;
  double checkpoint = RunOptions().checkpoint_interval_s;
  bool kitti = false, quiet = false, no_loops = false, loop_pictures = false, job = false, view_exit = false,
       view_paused = false, no_report = false, live = false;
};

void add_options(CLI::App& command, RunArguments& a) {
  command
      .add_option("sequence", a.sequence,
                  "Folder, video file or ROS bag, whose format is recognized; or camera:0, the first camera of this "
                  "machine (camera:/dev/video2, camera:rtsp://... name others)")
      ->required();
  command.add_option("-o,--out", a.out, "Folder for the results; it is created")->required();
  add_dataset_options(command, a.dataset);
  CLI::Option* live = command.add_flag("--live", a.live,
                                       "Play the sequence at its own pace, as a camera would give it: frames that come "
                                       "too fast are dropped. A camera is always live");
  add_scale_options(command, a.scale);
  command.add_option("--config", a.config, "Settings (YAML)");
  command.add_option("--set", a.set, "One setting, e.g. selection.strategy=gradient; can be repeated")
      ->type_name("KEY=VALUE");
  command.add_option("--threads", a.threads, "Threads that work on a frame; the result does not depend on it");
  command.add_option("--vocabulary", a.vocabulary, "Visual vocabulary for loop closing instead of the built-in one")
      ->check(CLI::ExistingFile);
  CLI::Option* no_loops = command.add_flag("--no-loops", a.no_loops, "Odometry alone, without loop closing");
  command.add_flag("--loop-pictures", a.loop_pictures, "Also write a picture of each closed loop: loops/*.png")
      ->excludes(no_loops);
  command.add_flag("--kitti", a.kitti, "Also write trajectory_kitti.txt");
  CLI::Option* view = command.add_flag(
      "--view{127.0.0.1}", a.view,
      "Show the run on a page in the browser while it goes on; --view=ADDRESS:PORT to serve it elsewhere than at " +
          viewer_url("127.0.0.1", kDefaultViewerPort, ""));
  command.add_flag("--view-exit", a.view_exit, "End with the run instead of serving the page until Ctrl-C")
      ->needs(view);
  command.add_flag("--view-paused", a.view_paused, "Wait at the first frame until the page says continue or step")
      ->needs(view)
      ->excludes(live);
  command
      .add_option("--checkpoint", a.checkpoint,
                  "Seconds from one checkpoint to the next (0: none): what `ldso resume` makes results of")
      ->check(number_from_zero())
      ->capture_default_str();
  command.add_flag("--no-report", a.no_report, "Do not write report.html");
  command.add_flag("--quiet", a.quiet, "Print warnings only");
  command.add_flag(
      "--job", a.job,
      "As a job of an experiment: log.txt and failure.json go to the results as well, and nothing is done if "
      "there is a result already or another process is at it");
}

Settings read_all_settings(const RunArguments& a) {
  Settings settings;
  if (a.config) read_settings(*a.config, settings);
  set_settings(settings, a.set);
  if (a.threads) settings.threads = *a.threads;
  if (a.vocabulary) settings.loops.vocabulary = a.vocabulary->string();
  if (a.no_loops) settings.loops.enabled = false;
  settings.validate();
  return settings;
}

/// Passes messages to the display and keeps the warnings for run.json.
class WarningLog {
 public:
  explicit WarningLog(ProgressDisplay& display) : display_(display) {}

  void operator()(LogLevel level, const std::string& text) {
    display_.message(level, text);
    if (level != LogLevel::kWarning) return;
    const std::lock_guard lock(mutex_);
    warnings_.push_back(text);
  }
  std::vector<std::string> warnings() const { return warnings_; }

 private:
  ProgressDisplay& display_;
  std::mutex mutex_;
  std::vector<std::string> warnings_;
};

/// What is run.
struct Input {
  std::unique_ptr<Dataset> dataset;     ///< Of a camera: what there is to know of it.
  std::unique_ptr<FrameStream> stream;  ///< Of a live run.
  bool is_camera = false;
};

Input open_input(const RunArguments& a) {
  Input input;
  if (const std::optional<std::string> camera = camera_of(a.sequence.string())) {
    input.is_camera = true;
    input.stream = open_camera(*camera, a.dataset);
    input.dataset = make_camera_dataset(*camera, input.stream->calibration());
    return input;
  }
  input.dataset = open_dataset(a.sequence, a.dataset);
  if (a.live && input.dataset->calibration().is_guess()) {
    throw Error(a.sequence.string(), "there is no calibration of the camera, and a live run cannot look for it",
                "run it without --live first, which writes camera.txt, and give that with --calib");
  }
  if (a.live) input.stream = make_paced_stream(*input.dataset);
  return input;
}

std::string describe_drops(const LiveFigures& live) {
  return std::to_string(live.dropped) + " frames were dropped, at most " + std::to_string(live.longest_gap) +
         " in a row: they came faster than they could be processed";
}

LiveRunOptions live_options(const RunArguments& a, const Input& input) {
  LiveRunOptions options;
  options.has_control = input.stream == nullptr;
  options.name = a.sequence.lexically_normal().string();
  add_truth(*input.dataset, options);
  if (a.view) options.server = make_server_options(*a.view);
  options.is_paused = a.view_paused;
  return options;
}

/// Runs the sequence with everything that is shown meanwhile. Whether Ctrl-C ended it.
bool run_with_display(const Input& input, const RunArguments& a, LiveRun& live, OutputFolder& out,
                      RunSummary& summary) {
  ProgressDisplay display(a.quiet);
  WarningLog warnings(display);
  const auto log = [&](LogLevel level, const std::string& text) {
    warnings(level, text);
    live.log(level, text);
  };
  for (const std::string& warning : input.dataset->warnings()) log(LogLevel::kWarning, warning);
  const InterruptGuard interrupt;
  RunOptions options;
  options.stop = &interrupt.flag();
  options.observer = live.observer();
  DoctorHint hint(input.is_camera ? "" : a.sequence.lexically_normal().string(), log);
  options.progress = [&](const RunProgress& progress) {
    display.update(progress);
    hint.after_frame(progress.frame);
    live.after_frame(progress.done, progress.count, interrupt.flag(), progress.dropped);
  };
  CheckpointWriter checkpoints(out, summary, *input.dataset,
                               [&](const std::string& problem) { log(LogLevel::kWarning, problem); });
  options.checkpoint_interval_s = a.checkpoint;
  if (a.checkpoint > 0)
    options.checkpoint = [&](SequenceRun run) { checkpoints.write(std::move(run), live.recording()); };
  live.after_frame(0, input.dataset->size(), interrupt.flag());
  const double paused_before = live.paused_seconds();
  summary.run = input.stream ? run_live(*input.stream, summary.settings, log, options)
                             : run_sequence(*input.dataset, summary.settings, log, options);
  checkpoints.close();
  if (input.is_camera) summary.run.stopped = false;  // It has no other end.
  summary.run.seconds -= live.paused_seconds() - paused_before;
  if (summary.run.stopped) log(LogLevel::kWarning, "interrupted: the frames up to here are saved");
  if (summary.run.live && summary.run.live->dropped > 0) log(LogLevel::kWarning, describe_drops(*summary.run.live));
  live.finish();
  summary.recording = live.recording();
  summary.frame_costs = live.frame_costs();
  summary.warnings = warnings.warnings();
  return interrupt.flag();
}

/// Puts the result into metres, if a known length was given and tells its unit.
void make_metric(const RunArguments& a, const Dataset& dataset, RunSummary& summary) {
  if (a.scale.is_empty()) return;
  summary.scale = estimate_scale(a.scale, summary.run.result, summary.run.calibration, dataset);
  if (summary.scale->problem.empty()) {
    scale_result(summary.scale->metres_per_unit, summary.run.result);
    return;
  }
  summary.warnings.push_back("the scale stays free, " + summary.scale->source + ": " + summary.scale->problem);
  std::cerr << "warning: " << summary.warnings.back() << "\n";
}

/// What makes no sense for this sequence is said before the run.
void check_scale(const RunArguments& a, const Input& input) {
  if (input.is_camera && a.scale.tag)
    throw Error("--scale-tag", "the images of a camera are not kept, so that no tag can be looked for",
                "record, and run the recording");
  check_request(a.scale, input.dataset->size());
}

/// Everything that the run leaves, as far as it can be written; what could not be is said. Whether all was.
bool write_results(const RunArguments& a, const Dataset& dataset, OutputFolder& out, RunSummary& summary) {
  const auto warn = [](const std::string& warning) { std::cerr << "warning: " << warning << "\n"; };
  const std::vector<std::string> problems =
      write_run_results(out, summary, dataset, {a.kitti, a.loop_pictures, !a.no_report}, warn);
  for (const std::string& problem : problems) std::cerr << "error: " << problem << "\n";
  return problems.empty();
}

int exit_code_of(const RunSummary& summary) {
  if (summary.run.stopped) return kInterruptedExitCode;
  return summary.trajectory.empty() ? kNothingTrackedExitCode : 0;
}

/// Nothing that the run reads may lie where its results go.
void check_output(const RunArguments& a) {
  if (camera_of(a.sequence.string())) return;
  std::vector<fs::path> files;
  for (const std::optional<fs::path>& file : {a.dataset.calibration_file, a.dataset.mask, a.config, a.vocabulary}) {
    if (file) files.push_back(*file);
  }
  refuse_output_in_input(a.out, a.sequence, files);
}

int run(const RunArguments& a) {
  RunSummary summary;
  summary.sequence_path = a.sequence;
  summary.dataset_options = a.dataset;
  summary.settings = read_all_settings(a);
  const Input input = open_input(a);
  const Dataset& dataset = *input.dataset;
  check_scale(a, input);
  OutputFolder out = prepare_output_folder(a.out);
  if (!a.quiet) std::cout << "calibration    " << dataset.calibration().description << std::endl;

  LiveRun live(live_options(a, input));
  if (a.view) announce_page(live.url());

  const bool was_interrupted = run_with_display(input, a, live, out, summary);
  make_metric(a, dataset, summary);
  const std::string ended_early = summary.run.error;
  const bool is_complete = write_results(a, dataset, out, summary);
  if (!a.quiet) std::cout << summary_text(summary) << "results        " << a.out.string() << "\n";
  if (!is_complete) {
    std::cerr << "error: " << a.out.string() << ": results are missing; make room and run again\n";
    return kIncompleteExitCode;
  }
  if (!ended_early.empty()) {
    throw Error(a.sequence.string(), "the run ended early: " + ended_early,
                "the frames up to there are saved in " + a.out.string());
  }
  const int code = exit_code_of(summary);
  if (a.view && !a.view_exit && !was_interrupted) serve_until_interrupted(live.url());
  if (code == kNothingTrackedExitCode) {
    const auto stretches = untracked_stretches(summary);
    std::cerr << "error: " << a.sequence.string() << ": no frame could be tracked"
              << (stretches.empty() ? "" : "; last reason: " + stretches.back().reason)
              << (input.is_camera ? "" : "; `ldso doctor " + a.sequence.string() + "` says what may be wrong") << "\n";
  }
  return code;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Track the camera through a sequence and map what it sees");
  add_options(*command, *arguments);
  command->callback([arguments, &exit_code] {
    check_output(*arguments);
    const auto action = [&] { return run(*arguments); };
    exit_code = arguments->job ? run_as_job(arguments->out, action) : action();
  });
}

}  // namespace ldso
