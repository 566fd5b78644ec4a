#include "commands/commands.h"

#include <iostream>
#include <memory>

#include "io/settings/settings_list.h"

namespace ldso {
namespace {

struct SettingsArguments {
  bool expert = false, json = false, markdown = false;
};

void print_settings(const SettingsArguments& a) {
  if (a.markdown) {
    std::cout << settings_markdown();
  } else if (a.json) {
    std::cout << settings_list_json(a.expert).dump(2) << "\n";
  } else {
    std::cout << settings_table(a.expert);
    if (!a.expert) std::cout << "\nThere are more for experts: ldso settings --expert\n";
  }
}

}  // namespace

void add_settings_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("settings", "List the settings for --set and --config");
  const auto arguments = std::make_shared<SettingsArguments>();
  command->add_flag("--expert", arguments->expert, "Those that are rarely worth a change, too");
  CLI::Option* json = command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--markdown", arguments->markdown, "All of them as docs/settings.md")->excludes(json);
  command->callback([arguments] { print_settings(*arguments); });
}

}  // namespace ldso
