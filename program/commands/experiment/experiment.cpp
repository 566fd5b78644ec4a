#include <algorithm>

#include "commands/experiment/experiment_commands.h"

namespace ldso {

void add_experiment_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("experiment", "Run a plan of many runs, on one machine or many, and sum it up");
  command->require_subcommand(1);
  command->footer("ldso experiment PLAN -o OUT is short for ldso experiment run PLAN -o OUT.");
  add_experiment_run_command(*command, exit_code);
  add_experiment_status_command(*command);
  add_experiment_summarize_command(*command);
  add_experiment_compare_command(*command, exit_code);
  add_experiment_demo_command(*command, exit_code);
}

std::vector<std::string> without_experiment_shorthands(std::vector<std::string> arguments, const CLI::App& app) {
  if (arguments.size() < 3 || arguments[1] != "experiment") return arguments;
  const auto commands = app.get_subcommand("experiment")->get_subcommands([](const CLI::App*) { return true; });
  const std::string first = arguments[2];
  const auto is_first = [&](const CLI::App* command) { return command->get_name() == first; };
  if (first == "-h" || first == "--help" || std::any_of(commands.begin(), commands.end(), is_first)) return arguments;
  const auto demo = std::find(arguments.begin() + 2, arguments.end(), "--demo");
  const bool is_demo = demo != arguments.end();
  if (is_demo) arguments.erase(demo);
  arguments.insert(arguments.begin() + 2, is_demo ? "demo" : "run");
  return arguments;
}

}  // namespace ldso
