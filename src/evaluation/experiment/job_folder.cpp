#include "evaluation/experiment/job_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRun = "run.json";
constexpr const char* kFailure = "failure.json";

std::optional<Json> read_json(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  Json json = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded() || !json.is_object()) return std::nullopt;
  return json;
}

/// Opening a folder makes network file systems ask the server for its present entries; a mere look for a file may be
/// answered from what this machine remembers.
void refresh(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
}

JobOutcome outcome_of_run(const Json& run) {
  JobOutcome outcome;
  if (run.value("interrupted", false)) return outcome;
  if (run.contains("timing") && run["timing"].is_object() && run["timing"].contains("wall_s"))
    outcome.seconds = run["timing"]["wall_s"].get<double>();
  outcome.state = JobState::kFinished;
  if (run.contains("error") && run["error"].is_string()) {
    outcome.state = JobState::kFailed;
    outcome.reason = run["error"].get<std::string>();
  } else if (run.contains("counts") && run["counts"].value("frames_with_pose", 1) == 0) {
    outcome.state = JobState::kFailed;
    outcome.reason = "no frame could be tracked";
  }
  return outcome;
}

int open_lock(const fs::path& folder) {
  const int descriptor = open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  throw Error((folder / "lock").string(), std::string("cannot be opened (") + std::strerror(errno) + ")",
              "check the permissions and the free space");
}

}  // namespace

fs::path job_folder(const fs::path& experiment, const std::string& id) { return experiment / "jobs" / id; }

JobOutcome read_outcome(const fs::path& folder) {
  refresh(folder);
  std::error_code error;
  try {
    if (const auto run = read_json(folder / kRun)) {
      JobOutcome outcome = outcome_of_run(*run);
      outcome.written = fs::last_write_time(folder / kRun, error);
      if (outcome.state != JobState::kOpen) return outcome;
    }
    if (const auto failure = read_json(folder / kFailure)) {
      return {JobState::kFailed, std::nullopt, failure->value("reason", std::string()),
              fs::last_write_time(folder / kFailure, error)};
    }
  } catch (const Json::exception&) {  // Not what `ldso run` writes.
  }
  return {};
}

void write_failure(const fs::path& folder, const JobFailure& failure) {
  const Json json{{"exit_code", failure.exit_code},
                  {"signal", failure.signal ? Json(*failure.signal) : Json()},
                  {"reason", failure.reason}};
  write_file(folder / kFailure, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void clear_outcome(const fs::path& folder) {
  for (const char* name : {kRun, kFailure}) fs::remove(folder / name);
}

std::string last_error(const fs::path& folder) {
  constexpr std::string_view kPrefix = "error: ";
  std::ifstream file(folder / "log.txt");
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
