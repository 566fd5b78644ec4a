#include "commands/commands.h"

#include <filesystem>
#include <memory>
#include <string>

#include "ldso/error.h"
#include "terminal/browser.h"
#include "viewer/recording/recording_file.h"
#include "viewer/server/server.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  fs::path run;
  std::string address;
};

void view(const ViewArguments& a) {
  const fs::path path = fs::is_directory(a.run) ? a.run / kRecordingName : a.run;
  if (!fs::exists(path))
    throw Error(path.string(), "there is no recording", "give the folder of a finished `ldso run`");
  LiveMap map;
  read_recording(path, map);
  const Server server(
      make_server_options(a.address), map, [](LiveMap&, std::size_t) {}, [](protocol::Command) {});
  announce_page(server.url());
  serve_until_interrupted(server.url());
}

}  // namespace

void add_view_command(CLI::App& app) {
  auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "Replay a finished run in the browser");
  command->add_option("run", arguments->run, "Folder that `ldso run -o` wrote")->required();
  command->add_option("--address", arguments->address, "ADDRESS:PORT to serve the page at")
      ->default_str(viewer_url("127.0.0.1", kDefaultViewerPort, ""));
  command->callback([arguments] { view(*arguments); });
}

}  // namespace ldso
