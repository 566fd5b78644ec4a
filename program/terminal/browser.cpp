#include "terminal/browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>

#include "terminal/interrupt.h"

extern char** environ;

namespace ldso {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// The browser of the desktop. That it cannot be opened is no error: the address has been printed.
void open_browser(const std::string& url) {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  }
  // The shell leaves the browser to itself, so that nothing waits for it here.
  std::string shell = "sh", option = "-c", script = "xdg-open \"$0\" &", address = url;
  char* arguments[] = {shell.data(), option.data(), script.data(), address.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "sh", &actions, nullptr, arguments, environ) == 0) waitpid(child, nullptr, 0);
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace

void announce_page(const std::string& url) {
  std::cout << "viewer         " << url << std::endl;
  open_browser(url);
}

void serve_until_interrupted(const std::string& url) {
  std::cout << "the page stays at " << url << " until Ctrl-C" << std::endl;
  const InterruptGuard interrupt;
  interrupt.wait();
}

}  // namespace ldso
