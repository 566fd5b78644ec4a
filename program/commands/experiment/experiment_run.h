#pragma once
// `ldso experiment run`: all jobs of a plan that have no result yet.

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/plan/experiment_plan.h"
#include "experiment/plan/plan_file.h"

namespace ldso {

struct ExperimentRunOptions {
  std::filesystem::path out;
  std::optional<int> jobs;  ///< At a time; without: what the plan says, else as many as there are cores for.
  std::vector<std::string> only;
  bool retry_failed = false, print_jobs = false, skip_missing = false, quiet = false;
};

/// The plan in a file or the built-in one of that name. Throws Error.
ExperimentPlan load_plan(const std::string& plan, const PlanRoots& roots);

/// Runs or prints the jobs. Returns the exit code: 0 also if jobs have failed, for that is a result.
/// Throws Error if sequences are missing, or jobs were killed again and again.
int run_experiment(ExperimentPlan plan, const ExperimentRunOptions& options);

/// -o, --jobs, ..
void add_experiment_run_options(CLI::App& command, ExperimentRunOptions& options);

}  // namespace ldso
