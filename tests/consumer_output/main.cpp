// How a program does what `ldso run` does.
//
//   consumer SEQUENCE OUT           with all passes of self-calibration
//   consumer SEQUENCE OUT one       frame by frame, as if they came from a camera

#include <cstdio>
#include <memory>
#include <string>

#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "ldso/results_folder.h"
#include "ldso/sequence_run.h"
#include "ldso/slam.h"

namespace {

void print(ldso::LogLevel level, const std::string& text) {
  std::printf("%s%s\n", level == ldso::LogLevel::kWarning ? "warning: " : "", text.c_str());
}

void run_all(const ldso::Dataset& dataset, const std::string& sequence, const std::string& out) {
  const ldso::Settings settings;
  ldso::ResultsFolder results(out, dataset, settings, {.log = print, .sequence = sequence});
  results.write(ldso::run_sequence(dataset, settings, results.log(), {.observer = results.observer()}));
}

void run_one_by_one(const ldso::Dataset& dataset, const std::string& out) {
  const ldso::Settings settings;
  ldso::ResultsFolder results(out, dataset.calibration(), settings, {.name = "one by one", .log = print});
  ldso::Slam slam(dataset.calibration(), settings, results.log(), results.observer());
  for (int i = 0; i < dataset.size(); ++i) {
    const ldso::RawFrame frame = dataset.read(i);
    slam.process(frame.grey.view(), frame.timestamp, frame.exposure_ms);
  }
  std::printf("%zu poses before the end\n", slam.snapshot().trajectory().size());
  results.write(slam.finish());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  try {
    const std::unique_ptr<ldso::Dataset> dataset = ldso::open_dataset(argv[1]);
    if (argc == 3) {
      run_all(*dataset, argv[1], argv[2]);
    } else {
      run_one_by_one(*dataset, argv[2]);
    }
    return 0;
  } catch (const ldso::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
