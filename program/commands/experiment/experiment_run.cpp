#include "commands/experiment/experiment_run.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "commands/experiment/builtin_plans.h"
#include "commands/experiment/experiment_commands.h"
#include "experiment/jobs/job_file.h"
#include "experiment/jobs/job_folder.h"
#include "experiment/jobs/job_runner.h"
#include "experiment/jobs/run_file.h"
#include "experiment/jobs/time_left.h"
#include "experiment/results/experiment_listing.h"
#include "io/text/nearest_name.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "terminal/interrupt.h"
#include "terminal/option_checks.h"
#include "terminal/progress_bar.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// "12/60 done, 2 running, 1 failed, 5 min left"
std::string progress_text(const RunnerProgress& progress) {
  const int done = progress.finished + progress.failed;
  std::string text = std::to_string(done) + "/" + std::to_string(progress.count) + " done, " +
                     std::to_string(progress.running) + " running";
  if (progress.elsewhere > 0) text += ", " + std::to_string(progress.elsewhere) + " elsewhere";
  text += ", " + std::to_string(progress.failed) + " failed";
  if (progress.seconds_left && done < progress.count)
    text += ", " + readable_duration(*progress.seconds_left) + " left";
  return text;
}

/// This very program: while it runs, also if its file is replaced by a newer one, and so the same for all jobs.
JobProgram this_program() {
  std::error_code error;
  const fs::path link = "/proc/self/exe", file = fs::read_symlink(link, error);
  if (error) throw Error(link.string(), "cannot be read (" + error.message() + ")", "/proc must be mounted");
  return {link, file.string()};
}

int jobs_at_a_time(const ExperimentPlan& plan, const ExperimentRunOptions& options) {
  if (options.jobs) return *options.jobs;
  if (plan.jobs) return *plan.jobs;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / plan.threads);
}

/// Everything that is missing is said before anything is run.
void check_sequences(ExperimentPlan& plan, const ExperimentRunOptions& options) {
  const std::vector<IncompleteSequence> incomplete = find_incomplete(plan);
  if (incomplete.empty()) return;
  const std::string text = plan.origin + ": " + describe_incomplete(incomplete, plan.sequences.size());
  const std::size_t rest = plan.sequences.size() - incomplete.size();
  if (!options.skip_missing) {
    throw Error(text + "\ncheck --root" +
                (rest > 0 ? ", or run the other " + std::to_string(rest) + " with --skip-missing" : ""));
  }
  if (rest == 0) throw Error(text + "\nNothing is left to run");
  std::cerr << "warning: " << text << "\n";
  remove_sequences(plan, incomplete);
}

/// Whether a job is to be printed; makes it open again if it has failed and is to be retried.
bool is_to_be_printed(const fs::path& folder, bool retry_failed, int& busy) {
  const RunState state = read_run(folder).state;
  if (state == RunState::kFinished || (state == RunState::kFailed && !retry_failed)) return false;
  create_folder(folder);
  const std::optional<JobLock> lock = JobLock::try_acquire(folder);
  if (!lock) {
    ++busy;
    return false;
  }
  clear_run(folder);
  return true;
}

void print_jobs(const std::vector<ExperimentJob>& jobs, const ExperimentRunOptions& options) {
  const std::string program = this_program().name;
  int printed = 0, busy = 0;
  for (const ExperimentJob& job : jobs) {
    const fs::path folder = job_folder(options.out, job.id);
    if (!is_to_be_printed(folder, options.retry_failed, busy)) continue;
    write_job(folder, job);
    std::vector<std::string> words{program};
    words.insert(words.end(), job.arguments.begin(), job.arguments.end());
    words.emplace_back("--job");
    std::cout << shell_quoted(words) << "\n";
    ++printed;
  }
  if (options.quiet) return;
  std::cerr << printed << " of " << jobs.size() << " jobs printed";
  if (busy > 0) std::cerr << "; " << busy << " more are running";
  std::cerr << "\n";
}

RunnerReport run_all(const std::vector<ExperimentJob>& jobs, const ExperimentPlan& plan,
                     const ExperimentRunOptions& options) {
  ProgressBar bar(options.quiet, 1);
  const InterruptGuard interrupt;
  RunnerOptions runner;
  runner.experiment = options.out;
  runner.program = this_program();
  runner.parallel = jobs_at_a_time(plan, options);
  runner.retry_failed = options.retry_failed;
  runner.stop = &interrupt.flag();
  runner.progress = [&](const RunnerProgress& progress) {
    bar.update(progress.finished + progress.failed, progress.count, progress_text(progress));
  };
  runner.failed = [&](const ExperimentJob& job, const std::string& reason) {
    bar.message(LogLevel::kInfo, job.id + ": failed: " + reason);
  };
  return run_jobs(jobs, runner);
}

int report_end(const RunnerReport& report, const ExperimentRunOptions& options) {
  if (report.stopped) {
    std::cerr << "interrupted: finished jobs are kept, the same command runs the others\n";
    return kInterruptedExitCode;
  }
  if (!report.killed.empty()) {
    throw Error(report.killed.front(),
                "was killed again and again from outside, as were " + std::to_string(report.killed.size() - 1) +
                    " other jobs; they have no result",
                "if memory ran out, give fewer --jobs; the same command runs them again");
  }
  if (!options.quiet) {
    std::cout << "finished       " << report.finished << " jobs";
    if (report.failed > 0) std::cout << ", " << report.failed << " failed (ldso experiment status says why)";
    std::cout << "\nrun here       " << report.started << "\nresults        " << options.out.string() << "\n";
  }
  return 0;
}

}  // namespace

ExperimentPlan load_plan(const std::string& plan, const PlanRoots& roots) {
  std::error_code error;
  // A folder may well have a plan's name: that of its results.
  if (fs::exists(plan, error) && !fs::is_directory(plan, error)) return read_plan(plan, roots);
  std::vector<std::string> names;
  for (const auto& [name, text] : builtin_plans()) {
    if (name == plan) return parse_plan(text, name, fs::current_path(), roots);
    names.push_back(name);
  }
  std::string list;
  for (const std::string& name : names) list.append(list.empty() ? "" : ", ").append(name);
  throw Error(plan, "there is no such file, nor a plan of that name",
              "plans that come with the program: " + list + "; did you mean " + nearest_name(plan, names) +
                  "? ldso experiment --help lists the commands");
}

int run_experiment(ExperimentPlan plan, const ExperimentRunOptions& given) {
  ExperimentRunOptions options = given;
  options.out = fs::absolute(given.out).lexically_normal();
  check_sequences(plan, options);
  const std::vector<ExperimentJob> all = plan_jobs(plan, options.out);
  const std::vector<ExperimentJob> jobs = select_jobs(all, options.only);
  ExperimentListing listing{plan.title, {}};
  for (const ExperimentJob& job : all) listing.jobs.push_back(job.id);
  refuse_changed_jobs(jobs, options.out);
  write_listing(options.out, listing);
  if (options.print_jobs) {
    print_jobs(jobs, options);
    return 0;
  }
  const RunnerReport report = run_all(jobs, plan, options);
  summarize_experiment(options.out, options.quiet);
  return report_end(report, options);
}

void add_experiment_run_options(CLI::App& command, ExperimentRunOptions& options) {
  command.add_option("-o,--out", options.out, "Folder of the experiment; what it holds already is kept")->required();
  command.add_option("--jobs", options.jobs, "Jobs at a time (default: the plan's, else cores / threads of a job)")
      ->check(positive_number());
  command
      .add_option("--only", options.only,
                  "Only jobs with this in their name (SEQUENCE/VARIANT/DIRECTION_NUMBER); * and ? as in a shell; "
                  "can be repeated")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  command.add_flag("--retry-failed", options.retry_failed, "Run jobs again that have failed");
  command.add_flag("--quiet", options.quiet, "Print warnings only");
}

void add_experiment_run_command(CLI::App& experiment, int& exit_code) {
  struct Arguments {
    std::string plan;
    std::vector<std::string> roots;
    ExperimentRunOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = experiment.add_subcommand("run", "Run all jobs of a plan that have no result yet");
  command->add_option("plan", arguments->plan, "File (YAML), or the name of a plan that comes with the program")
      ->required();
  add_experiment_run_options(*command, arguments->options);
  command
      ->add_option("--root", arguments->roots,
                   "Where the sequences lie; with several datasets one for each, as NAME=FOLDER")
      ->type_name("[NAME=]FOLDER")
      ->allow_extra_args(false);
  command->add_flag("--skip-missing", arguments->options.skip_missing, "Run what is there of the sequences");
  command->add_flag("--print-jobs", arguments->options.print_jobs,
                    "Run nothing; print a command for each job that has no result, one a line");
  command->callback([arguments, &exit_code] {
    exit_code = run_experiment(load_plan(arguments->plan, parse_roots(arguments->roots)), arguments->options);
  });
}

}  // namespace ldso
