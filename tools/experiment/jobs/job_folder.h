#pragma once
// Where the folder of a job is, whether somebody is at it, and what its log says. See job.h for the files, run_file.h
// for how the job ended.

#include <filesystem>
#include <optional>
#include <string>

namespace ldso {

/// What a job has printed.
inline constexpr const char* kLogName = "log.txt";

/// The folder of a job below that of its experiment.
std::filesystem::path job_folder(const std::filesystem::path& experiment, const std::string& id);

/// The last error message in log.txt without "error: "; empty if there is none.
std::string last_error(const std::filesystem::path& folder);

/// The right to run a job, on this machine and on others that share the folder: an flock on the file `lock`. It lasts
/// until this object and all processes that inherited the descriptor are gone, so a job whose runner was killed keeps
/// its folder until it is gone as well.
class JobLock {
 public:
  /// Nothing if another has it. The folder must exist. Throws Error if the file cannot be made or locked.
  static std::optional<JobLock> try_acquire(const std::filesystem::path& folder);
  /// The right to write into a folder that runners share, once no other has it: an flock on the folder itself.
  static JobLock wait_for_folder(const std::filesystem::path& folder);
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
