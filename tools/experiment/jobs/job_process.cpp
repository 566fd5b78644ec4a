#include "experiment/jobs/job_process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

/// A file descriptor that is closed with it.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }
  int release() { return std::exchange(value_, -1); }
  void reset() {
    if (value_ >= 0) close(std::exchange(value_, -1));
  }

 private:
  int value_;
};

struct Pipe {
  Pipe() : Pipe(make()) {}
  Descriptor read, write;

 private:
  explicit Pipe(std::array<int, 2> ends) : read(ends[0]), write(ends[1]) {}
  static std::array<int, 2> make() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) == 0) return ends;
    throw Error("pipe", std::strerror(errno), "run fewer jobs at a time");
  }
};

/// What the child needs, made ready before: between fork and exec nothing may allocate.
struct Start {
  const char* program;
  char* const* arguments;
  int input, log, lock, end, problem;
  pid_t runner;
};

void keep_on_exec(int descriptor) {
  if (descriptor >= 0) fcntl(descriptor, F_SETFD, 0);
}

[[noreturn]] void become_job(const Start& start) {
  setpgid(0, 0);
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != start.runner) _exit(1);  // It has died already.
#endif
  dup2(start.input, STDIN_FILENO);
  dup2(start.log, STDOUT_FILENO);
  dup2(start.log, STDERR_FILENO);
  keep_on_exec(start.lock);
  keep_on_exec(start.end);
  execv(start.program, start.arguments);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = write(start.problem, &error, sizeof(error));
  _exit(127);
}

std::vector<char*> argument_list(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> list{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  return list;
}

Descriptor open_log(const std::filesystem::path& log) {
  const int descriptor = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor >= 0) return Descriptor(descriptor);
  throw Error(log.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
              "check the permissions and the free space");
}

}  // namespace

JobProcess::JobProcess(const JobProgram& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& log, int lock) {
  const Descriptor log_file = open_log(log), nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
  Pipe end, problem;
  const std::vector<char*> list = argument_list(program.name, arguments);
  const Start start{program.file.c_str(), list.data(),         nothing.get(), log_file.get(), lock,
                    end.write.get(),      problem.write.get(), getpid()};
  pid_ = fork();
  if (pid_ == 0) become_job(start);
  if (pid_ < 0) throw Error("fork", std::strerror(errno), "run fewer jobs at a time");
  setpgid(pid_, pid_);  // Here as well: whoever comes first.
  end.write.reset();
  problem.write.reset();
  int error = 0;
  ssize_t count = 0;
  do count = read(problem.read.get(), &error, sizeof(error));
  while (count < 0 && errno == EINTR);
  end_ = end.read.release();
  if (count == 0) return;  // Closed by exec.
  wait();
  close(std::exchange(end_, -1));
  throw Error(program.file.string(), std::string("cannot be run (") + std::strerror(error) + ")", "check the program");
}

JobProcess::~JobProcess() {
  if (pid_ > 0) {
    send(SIGKILL);
    wait();
  }
  if (end_ >= 0) close(end_);
}

JobProcess::JobProcess(JobProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), end_(std::exchange(other.end_, -1)) {}

JobProcess& JobProcess::operator=(JobProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(end_, other.end_);
  return *this;
}

void JobProcess::send(int signal) const {
  if (pid_ > 0) kill(-pid_, signal);
}

ProcessEnd JobProcess::wait() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0) {
    if (errno != EINTR) break;
  }
  pid_ = -1;
  if (WIFSIGNALED(status)) return {128 + WTERMSIG(status), WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

}  // namespace ldso
