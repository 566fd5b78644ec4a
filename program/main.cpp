// The `ldso` program: one subcommand a file.

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <vector>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "commands/commands.h"
#include "commands/experiment/experiment_commands.h"
#include "results/versions.h"
#include "terminal/command_line.h"

namespace {

/// What is OpenCV's for the whole process is set here, and nowhere in the libraries.
void set_up_opencv() {
  cv::setNumThreads(1);  // ldso has threads of its own; OpenCV's would only compete with them.
  // It tries one video library after the other and prints what each of them says; ldso says itself what went wrong.
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

/// Images are made on one thread and let go of on another. With a heap for each thread, as glibc has them, every one of
/// them keeps what was largest once: the kitchen with self-calibration took 685 MB instead of 382.
void set_up_heap() {
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace

int main(int argc, char** argv) {
#ifdef __linux__
  prctl(PR_SET_NAME, "ldso");  // Jobs of experiments are started as /proc/self/exe and would be called "exe".
#endif
  set_up_heap();
  set_up_opencv();
  CLI::App app("Monocular direct visual SLAM: images to a camera trajectory and a sparse map", "ldso");
  app.set_version_flag("--version", "ldso " + ldso::project_version() + " (" + ldso::compiler_version() + ")");
  app.require_subcommand(1);
  int exit_code = 0;
  ldso::add_run_command(app, exit_code);
  ldso::add_doctor_command(app, exit_code);
  ldso::add_calibrate_command(app);
  ldso::add_resume_command(app);
  ldso::add_view_command(app);
  ldso::add_export_command(app);
  ldso::add_eval_command(app);
  ldso::add_vocab_command(app);
  ldso::add_settings_command(app);
  ldso::add_bench_command(app);
  ldso::add_simulate_command(app);
  ldso::add_experiment_command(app, exit_code);
  const auto arguments = ldso::without_experiment_shorthands({argv, argv + argc}, app);
  std::vector<const char*> words;
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  return ldso::run_command_line(app, static_cast<int>(words.size()), words.data(), exit_code);
}
