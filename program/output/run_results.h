#pragma once
// All that a run leaves, in the order in which it is written.

#include <functional>
#include <string>
#include <vector>

#include "output/run_files.h"

namespace ldso {

struct RunResultsOptions {
  bool kitti = false;          ///< Also trajectory_kitti.txt.
  bool loop_pictures = false;  ///< Also loops/*.png.
  bool report = true;          ///< report.html.
};

/// Evaluates the run and writes its files, run.json last. `summary`: with the run, its settings and warnings; the rest
/// is filled in. `warn` hears what is odd but costs no file. One that cannot be written costs itself only: returns what
/// the errors say.
std::vector<std::string> write_run_results(OutputFolder& out, RunSummary& summary, const Dataset& dataset,
                                           const RunResultsOptions& options,
                                           const std::function<void(const std::string&)>& warn = {});

}  // namespace ldso
