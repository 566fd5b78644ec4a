#include <filesystem>
#include <iostream>
#include <memory>

#include "commands/commands.h"
#include "ldso/error.h"
#include "output/checkpoint_file.h"
#include "output/run_files.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

void resume(const fs::path& folder) {
  if (fs::exists(folder / kRunJson)) {
    std::cout << folder.string() << ": the run has ended with results already\n";
    return;
  }
  const fs::path checkpoint = folder / kCheckpointName;
  if (!fs::exists(checkpoint))
    throw Error(folder.string(), "there is no checkpoint of a run",
                "give the folder of an `ldso run -o` that was cut off");
  const std::string text = read_file(checkpoint), frames = describe_checkpoint(text, checkpoint.string());
  OutputFolder out = open_run_folder(folder);
  write_file(out.file(kRunJson), text);
  out.remove(kCheckpointName);
  std::cout << "frames         " << frames << "\nresults        " << folder.string() << "\n";
}

}  // namespace

void add_resume_command(CLI::App& app) {
  auto folder = std::make_shared<fs::path>();
  CLI::App* command =
      app.add_subcommand("resume", "Finish the results of a run that was cut off, from its last checkpoint");
  command->add_option("run", *folder, "Folder that `ldso run -o` wrote to")->required();
  command->callback([folder] { resume(*folder); });
}

}  // namespace ldso
