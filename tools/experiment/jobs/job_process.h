#pragma once
// A job as a process of its own that never outlives its runner.

#include <filesystem>
#include <string>
#include <vector>

namespace ldso {

struct ProcessEnd {
  int exit_code = 0;  ///< As shells have it: 128 + signal after a signal.
  int signal = 0;     ///< 0: it exited.
};

struct JobProgram {
  std::filesystem::path file;
  std::string name;  ///< As lists of processes show it.
};

class JobProcess {
 public:
  /// Starts `program arguments...`; what it prints goes to the file `log`, which is made anew. The process
  /// - is a process group of its own, so that Ctrl-C on the terminal reaches the runner alone;
  /// - is killed when the runner dies, however that happens (Linux);
  /// - inherits the descriptor `lock` and no other of the runner's but the standard ones.
  /// Only the thread that lives as long as the runner may start one: the system ties the process to its thread.
  /// Throws Error if the log cannot be made or the program cannot be run.
  JobProcess(const JobProgram& program, const std::vector<std::string>& arguments, const std::filesystem::path& log,
             int lock);
  /// Kills it if it has not ended.
  ~JobProcess();
  JobProcess(JobProcess&& other) noexcept;
  JobProcess& operator=(JobProcess&& other) noexcept;
  JobProcess(const JobProcess&) = delete;
  JobProcess& operator=(const JobProcess&) = delete;

  /// Readable (at its end) when the process has ended: for poll().
  int end_descriptor() const { return end_; }
  /// To the process and all it has started.
  void send(int signal) const;
  /// Waits for its end. Once.
  ProcessEnd wait();

 private:
  int pid_ = -1;
  int end_ = -1;
};

}  // namespace ldso
