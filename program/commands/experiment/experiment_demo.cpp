#include "commands/experiment/experiment_commands.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "commands/experiment/experiment_run.h"
#include "experiment/jobs/job_folder.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "simulation/sequences/stand_ins.h"
#include "terminal/interrupt.h"
#include "terminal/progress_bar.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using simulation::StandIn;

struct DemoArguments {
  std::string size = "full";
  std::string plan;
  bool fresh = false, render_only = false;
  ExperimentRunOptions run;
};

/// Written last of all.
constexpr const char* kMark = "world.yaml";

fs::path mark_of(const fs::path& sequence) { return sequence / kMark; }

/// Returns whether the sequence is complete: not if it was interrupted.
bool render(const StandIn& stand_in, const fs::path& folder, ThreadPool& pool, bool fresh, bool quiet) {
  create_folder(folder);
  const std::optional<JobLock> lock = JobLock::try_acquire(folder);
  if (!lock) throw Error(folder.string(), "is being rendered by another process", "wait for it");
  if (!fresh && fs::exists(mark_of(folder))) return true;  // By another process meanwhile.
  ProgressBar bar(quiet);
  const std::string name = stand_in.path.string();
  bar.message(LogLevel::kInfo, "rendering " + name);
  const InterruptGuard interrupt;
  const simulation::SimulatedSequence sequence = simulation::make_sequence(stand_in.recipe, &pool);
  const auto progress = [&](int done) {
    bar.update(done, sequence.size(), name + ": frame " + std::to_string(done) + "/" + std::to_string(sequence.size()));
    return !interrupt.flag().load();
  };
  const int frames = simulation::write_sequence(sequence, stand_in.recipe, folder, stand_in.write, pool, progress);
  if (frames == sequence.size()) return true;
  OutputFolder(folder).remove(kMark);
  return false;
}

bool render_all(const fs::path& root, const DemoArguments& a) {
  const bool small = a.size == "small";
  ThreadPool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  for (const StandIn& stand_in :
       simulation::stand_ins(small ? simulation::StandInSize::kSmall : simulation::StandInSize::kFull)) {
    const fs::path folder = root / stand_in.path;
    const bool is_there = !a.fresh && fs::exists(mark_of(folder));
    if (!is_there && !render(stand_in, folder, pool, a.fresh, a.run.quiet)) return false;
  }
  return true;
}

int run_demo(const DemoArguments& a) {
  const fs::path root = fs::absolute(a.run.out).lexically_normal() / "sequences" / a.size;
  if (!render_all(root, a)) return kInterruptedExitCode;
  if (a.render_only) return 0;
  PlanRoots roots;
  for (const char* dataset : {"tum_mono", "euroc", "kitti"}) roots.by_dataset[dataset] = root / dataset;
  const std::string plan = !a.plan.empty() ? a.plan : a.size == "small" ? "demo_small" : "demo";
  return run_experiment(load_plan(plan, roots), a.run);
}

}  // namespace

void add_experiment_demo_command(CLI::App& experiment, int& exit_code) {
  const auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command =
      experiment.add_subcommand("demo", "Render stand-ins for TUM-mono, EuRoC and KITTI and run a plan on them");
  add_experiment_run_options(*command, arguments->run);
  command->add_option("--size", arguments->size, "small: a minute of processor time; full: about ten on two cores")
      ->check(CLI::IsMember({"small", "full"}))
      ->capture_default_str();
  command->add_option("--plan", arguments->plan, "Another plan on the same stand-ins, e.g. nightly (default: demo)");
  command->add_flag("--fresh", arguments->fresh, "Render the stand-ins again even if they are there");
  command->add_flag("--render-only", arguments->render_only, "Run nothing");
  command->callback([arguments, &exit_code] { exit_code = run_demo(*arguments); });
}

}  // namespace ldso
