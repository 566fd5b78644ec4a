// The `ldso` program: one subcommand a file.

#include <CLI/CLI.hpp>
#include <string>

#include "app/command_line.h"
#include "app/eval.h"
#include "app/experiment_compare.h"
#include "app/experiment_summarize.h"
#include "app/run.h"
#include "app/versions.h"
#include "app/vocab.h"
#ifdef LDSO_HAS_SIMULATE
#include "app/simulate.h"
#endif

int main(int argc, char** argv) {
  CLI::App app("Monocular direct visual SLAM: images to a camera trajectory and a sparse map", "ldso");
  app.set_version_flag("--version", "ldso " + ldso::project_version() + " (" + ldso::compiler_version() + ")");
  app.require_subcommand(1);
  int exit_code = 0;
  ldso::add_run_command(app, exit_code);
  ldso::add_eval_command(app);
  CLI::App* experiment = app.add_subcommand("experiment", "Results of many runs");
  experiment->require_subcommand(1);
  ldso::add_summarize_command(*experiment, exit_code);
  ldso::add_compare_command(*experiment, exit_code);
  ldso::add_vocab_command(app);
#ifdef LDSO_HAS_SIMULATE
  ldso::add_simulate_command(app);
#endif
  return ldso::run_command_line(app, argc, argv, exit_code);
}
