#include "experiment/jobs/job_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

int open_lock(const fs::path& folder) {
  const int descriptor = open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  throw Error((folder / "lock").string(), std::string("cannot be opened (") + std::strerror(errno) + ")",
              "check the permissions and the free space");
}

}  // namespace

fs::path job_folder(const fs::path& experiment, const std::string& id) { return experiment / "jobs" / id; }

std::string last_error(const fs::path& folder) {
  constexpr std::string_view kPrefix = "error: ";
  std::ifstream file(folder / kLogName);
  std::string found;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(kPrefix)) found = line.substr(kPrefix.size());
  }
  return found;
}

std::optional<JobLock> JobLock::try_acquire(const fs::path& folder) {
  JobLock lock(open_lock(folder));
  while (flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return std::nullopt;
    if (errno == EINTR) continue;
    throw Error((folder / "lock").string(), std::string("cannot be locked (") + std::strerror(errno) + ")",
                "put the experiment on a file system that knows flock");
  }
  return lock;
}

JobLock JobLock::wait_for_folder(const fs::path& folder) {
  JobLock lock(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock.descriptor_ < 0) {
    throw Error(folder.string(), std::string("cannot be opened (") + std::strerror(errno) + ")",
                "check the permissions");
  }
  // A file system without flock knows no other runner either: their jobs take the same lock.
  while (flock(lock.descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  return lock;
}

bool JobLock::is_held(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / "lock", error)) return false;
  JobLock lock(open_lock(folder));
  return flock(lock.descriptor_, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

JobLock::JobLock(JobLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

JobLock& JobLock::operator=(JobLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

JobLock::~JobLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace ldso
