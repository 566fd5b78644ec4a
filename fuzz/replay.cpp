// fuzz_replay SEEDS [TARGET...]: gives each target (all, if none is named) the files in SEEDS/TARGET. It ends with 0 if
// every target survived; a target that has no seeds is a mistake.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "fuzz_target.h"

namespace ldso::fuzz {
namespace {

namespace fs = std::filesystem;

std::map<std::string, Target>& targets() {
  static std::map<std::string, Target> all;
  return all;
}

std::string content_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool replay(const fs::path& folder, const std::string& name) {
  const auto target = targets().find(name);
  std::error_code error;
  if (target == targets().end() || !fs::is_directory(folder / name, error)) {
    std::fprintf(stderr, "%s: there is no such target, or no folder with its seeds\n", name.c_str());
    return false;
  }
  std::vector<fs::path> seeds;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / name)) seeds.push_back(entry.path());
  std::sort(seeds.begin(), seeds.end());
  for (const fs::path& seed : seeds) {
    std::printf("%s\n", seed.string().c_str());
    std::fflush(stdout);  // So that the last line tells which seed it was.
    target->second(content_of(seed));
  }
  return !seeds.empty();
}

}  // namespace

Registration::Registration(const char* name, Target target) { targets().emplace(name, target); }

int replay_all(int argc, const char* const* argv) {
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (names.empty()) {
    for (const auto& [name, target] : targets()) names.push_back(name);
  }
  const bool all_good = argc >= 2 && std::all_of(names.begin(), names.end(),
                                                 [&](const std::string& name) { return replay(argv[1], name); });
  return all_good ? 0 : 1;
}

}  // namespace ldso::fuzz

int main(int argc, char** argv) { return ldso::fuzz::replay_all(argc, argv); }
