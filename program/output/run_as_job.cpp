#include "output/run_as_job.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <optional>
#include <string>

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/job_folder.h"
#include "experiment/jobs/run_file.h"
#include "ldso/error.h"
#include "output/run_files.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// While it lives, standard output and standard error go to a file.
class OutputToFile {
 public:
  explicit OutputToFile(const fs::path& path) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0) {
      throw Error(path.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
                  "check the permissions and the free space");
    }
    flush();
    out_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    error_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    close(file);
  }
  ~OutputToFile() {
    flush();
    dup2(out_, STDOUT_FILENO);
    dup2(error_, STDERR_FILENO);
    close(out_);
    close(error_);
  }
  OutputToFile(const OutputToFile&) = delete;
  OutputToFile& operator=(const OutputToFile&) = delete;

 private:
  static void flush() {
    std::cout.flush();
    std::fflush(nullptr);
  }

  int out_ = -1, error_ = -1;
};

/// What an experiment wrote into the folder of a job is ldso's as well.
OutputFolder open_job_folder(const fs::path& folder) {
  OutputFolder out = open_run_folder(folder);
  if (has_job(folder)) out.adopt({kLogName, kFailureName});
  out.check({kLogName, kFailureName, kRunJson});
  return out;
}

bool has_ended(const fs::path& folder) {
  if (read_run(folder).state == RunState::kPending) return false;
  std::cout << folder.string() << ": has a result already\n";
  return true;
}

/// What `run` returns, or the error that it ended with.
struct LoggedRun {
  int exit_code = 1;
  std::optional<std::string> error;
};

LoggedRun run_logged(const fs::path& log, const std::function<int()>& run) {
  const OutputToFile redirection(log);
  try {
    return {run(), std::nullopt};
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return {1, error.what()};
  }
}

}  // namespace

int run_as_job(const fs::path& folder, const std::function<int()>& run) {
  OutputFolder out = open_job_folder(folder);
  if (has_ended(folder)) return 0;
  const std::optional<JobLock> lock = JobLock::try_acquire(folder);
  if (!lock) {
    std::cerr << folder.string() << ": another process is at this job\n";
    return kBusyExitCode;
  }
  if (has_ended(folder)) return 0;
  clear_run(folder);
  out.file(kFailureName);
  const LoggedRun result = run_logged(out.file(kLogName), run);
  if (result.error && read_run(folder).state == RunState::kPending)
    write_failure(folder, {1, std::nullopt, *result.error});
  if (result.error) std::cerr << "error: " << *result.error << "\n";
  return result.exit_code;
}

}  // namespace ldso
