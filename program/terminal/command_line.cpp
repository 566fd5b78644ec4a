#include "terminal/command_line.h"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "io/text/nearest_name.h"
#include "util/out_of_memory.h"

namespace ldso {
namespace {

int fail(const std::string& message) {
  std::cerr << "error: " << message << "\n";
  return 1;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(std::string("--").append(name));
    for (const std::string& name : option->get_snames()) names.push_back(std::string("-").append(name));
  }
  return names;
}

std::string without_value(const std::string& argument) { return argument.substr(0, argument.find('=')); }

/// The command that was named (of commands in a command the innermost), or the program itself.
const CLI::App& chosen_command(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : chosen_command(*commands.front());
}

/// "; see ldso vocab train --help"
std::string see_help(const CLI::App& command) {
  std::string names;
  for (const CLI::App* app = &command; app->get_parent() != nullptr; app = app->get_parent())
    names.insert(0, app->get_name() + " ");
  return "; see ldso " + names + "--help";
}

std::string describe_extras(const CLI::App& app) {
  const CLI::App& command = chosen_command(app);
  const std::string help = see_help(command);
  const std::vector<std::string> extras = app.remaining(true);
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& word) { return word.size() >= 2 && word[0] == '-'; });
  if (option != extras.end()) {
    return "unknown option " + *option + "; did you mean " +
           nearest_name(without_value(*option), option_names(command)) + "?" + help;
  }
  std::string arguments;
  for (const std::string& argument : extras) arguments.append(" ").append(argument);
  return "too many arguments:" + arguments + help;
}

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

int run_command_line(CLI::App& app, int argc, const char* const* argv, const int& exit_code) {
  const std::vector<std::string> commands = command_names(app);
  const std::string first = argc > 1 ? argv[1] : "";
  if (!first.empty() && first[0] != '-' && !is_one_of(first, commands)) {
    return fail("unknown command " + first + "; did you mean " + nearest_name(first, commands) + "? see ldso --help");
  }
  try {
    app.parse(argc, argv);
    if (std::cout.flush()) return exit_code;
    return fail("the output cannot be written to where it goes; check that there is room");
  } catch (const CLI::ExtrasError&) {
    return fail(describe_extras(app));
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    // An option nobody knows is often why a required one is missing: name it first.
    const auto extras = app.remaining(true);
    if (!extras.empty() && extras.front()[0] == '-') return fail(describe_extras(app));
    const CLI::App& command = chosen_command(app);
    return fail(error.what() + see_help(command));
  } catch (const std::exception& error) {
    return fail(problem_of(error, "running `ldso " + first + "`"));
  }
}

}  // namespace ldso
