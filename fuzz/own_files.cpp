// .ldso_files, by which ldso knows which files of a folder are its own.

#include <fstream>

#include "fuzz_target.h"
#include "io/text/output_folder.h"

using namespace ldso;

namespace {

namespace fs = std::filesystem;

void touch(const fs::path& path) { std::ofstream(path) << "x"; }

}  // namespace

LDSO_FUZZ_TARGET(own_files) {
  const fs::path folder = fuzz::scratch_folder() / "out";
  fs::create_directories(folder / "loops");
  for (const char* name : {"run.json", "mine.txt", "loops/1.png"}) touch(folder / name);
  touch(fuzz::scratch_folder() / "outside.txt");
  fuzz::scratch_file("out/.ldso_files", input);
  std::error_code error;
  const auto opened = fuzz::accepted([&] { return OutputFolder(folder); });
  if (!opened) return;
  OutputFolder out = *opened;
  const bool owned_run = out.owns("run.json"), owned_mine = out.owns("mine.txt");
  const bool checked = fuzz::succeeds([&] { out.check({"run.json", "map.ply", "loops/"}); });
  if (checked) fuzz::expect(owned_run, "a file that is not listed is in the way");
  fuzz::succeeds([&] { out.remove("run.json"); });
  fuzz::expect(fs::exists(folder / "run.json", error) != owned_run, "only a listed file is removed");
  fuzz::succeeds([&] { out.remove("mine.txt"); });
  fuzz::expect(fs::exists(folder / "mine.txt", error) != owned_mine, "only a listed file is removed");
  fuzz::expect(fs::exists(fuzz::scratch_folder() / "outside.txt", error), "nothing outside is touched");
  if (checked) fuzz::expect(OutputFolder(folder).has_list(), "the list can be read again");
}
