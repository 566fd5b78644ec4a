#include "terminal/svg_to_png.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <vector>

namespace ldso {
namespace {

/// Runs a program found in PATH; its exit code, or -1.
int run_program(std::vector<std::string> arguments, bool quiet) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (quiet) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  pid_t child = 0;
  const int problem = posix_spawnp(&child, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool can_make_png() { return run_program({kPngProgram, "--version"}, true) == 0; }

bool make_png(const std::filesystem::path& svg, const std::filesystem::path& png) {
  const std::string input = std::filesystem::absolute(svg).string(), output = std::filesystem::absolute(png).string();
  return run_program({kPngProgram, "-o", output, input}, false) == 0;
}

}  // namespace ldso
