#pragma once
// What the folder of a job says: whether it has ended, how, and whether somebody is at it. See job.h for the files.

#include <filesystem>
#include <optional>
#include <string>

namespace ldso {

/// The folder of a job below that of its experiment.
std::filesystem::path job_folder(const std::filesystem::path& experiment, const std::string& id);

enum class JobState {
  kOpen,      ///< Has no result: never run, interrupted or killed.
  kFinished,  ///< Has a result with a trajectory.
  kFailed,    ///< Has ended with an error or without a single pose: that is its result.
};

struct JobOutcome {
  JobState state = JobState::kOpen;
  std::optional<double> seconds;              ///< How long the run took, if run.json says it.
  std::string reason;                         ///< Why it has failed.
  std::filesystem::file_time_type written{};  ///< When, if it is not open.
};

/// Never throws: what cannot be read is open.
JobOutcome read_outcome(const std::filesystem::path& folder);

/// How `ldso run` ended without a result.
struct JobFailure {
  int exit_code = 0;  ///< As shells have it: 128 + signal after a signal.
  std::optional<int> signal;
  std::string reason;
};

/// Writes failure.json. Throws Error if that fails.
void write_failure(const std::filesystem::path& folder, const JobFailure& failure);

/// Removes what read_outcome() goes by, so that the job is open.
void clear_outcome(const std::filesystem::path& folder);

/// The last error message in log.txt without "error: "; empty if there is none.
std::string last_error(const std::filesystem::path& folder);

/// The right to run a job, on this machine and on others that share the folder: an flock on the file `lock`. It lasts
/// until this object and all processes that inherited the descriptor are gone, so a job whose runner was killed keeps
/// its folder until it is gone as well.
class JobLock {
 public:
  /// Nothing if another has it. The folder must exist. Throws Error if the file cannot be made or locked.
  static std::optional<JobLock> try_acquire(const std::filesystem::path& folder);
  /// Whether somebody has it.
  static bool is_held(const std::filesystem::path& folder);

  JobLock(JobLock&& other) noexcept;
  JobLock& operator=(JobLock&& other) noexcept;
  JobLock(const JobLock&) = delete;
  JobLock& operator=(const JobLock&) = delete;
  ~JobLock();

  int descriptor() const { return descriptor_; }  ///< Closed on exec.

 private:
  explicit JobLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_ = -1;
};

}  // namespace ldso
