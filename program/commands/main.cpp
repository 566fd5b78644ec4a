// The `ldso` program: one subcommand a file.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "camera/opencv_process.h"
#include "commands/eval.h"
#include "commands/experiment/experiment.h"
#include "commands/export.h"
#include "commands/run.h"
#include "commands/view.h"
#include "commands/vocab.h"
#include "results/versions.h"
#include "terminal/command_line.h"
#ifdef LDSO_HAS_SIMULATE
#include "commands/simulate.h"
#endif

int main(int argc, char** argv) {
#ifdef __linux__
  prctl(PR_SET_NAME, "ldso");  // Jobs of experiments are started as /proc/self/exe and would be called "exe".
#endif
  ldso::set_up_opencv();
  CLI::App app("Monocular direct visual SLAM: images to a camera trajectory and a sparse map", "ldso");
  app.set_version_flag("--version", "ldso " + ldso::project_version() + " (" + ldso::compiler_version() + ")");
  app.require_subcommand(1);
  int exit_code = 0;
  ldso::add_run_command(app, exit_code);
  ldso::add_view_command(app);
  ldso::add_export_command(app);
  ldso::add_eval_command(app);
  ldso::add_vocab_command(app);
#ifdef LDSO_HAS_SIMULATE
  ldso::add_simulate_command(app);
#endif
  ldso::add_experiment_command(app, exit_code);
  const auto arguments = ldso::without_experiment_shorthands({argv, argv + argc}, app);
  std::vector<const char*> words;
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  return ldso::run_command_line(app, static_cast<int>(words.size()), words.data(), exit_code);
}
