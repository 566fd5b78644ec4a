#pragma once
// A run that takes the place of an experiment's runner for its own job: for jobs that are started by other programs
// (GNU parallel, SLURM), maybe twice, maybe beside a runner.

#include <filesystem>
#include <functional>

namespace ldso {

/// Exit code of a job that another process is at ("try again later", as sysexits.h has it).
inline constexpr int kBusyExitCode = 75;

/// Calls `run`, holding the lock of the job's folder, with all output going to log.txt there; what it throws before it
/// has a result becomes failure.json. Does nothing if the folder has a result already (returns 0) or is locked
/// (kBusyExitCode). Otherwise returns what `run` does, or 1 if it throws.
int run_as_job(const std::filesystem::path& folder, const std::function<int()>& run);

}  // namespace ldso
