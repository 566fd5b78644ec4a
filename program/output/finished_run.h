#pragma once
// A finished run as its folder tells of it: what was played, with which camera.

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

struct FinishedRun {
  std::filesystem::path folder;
  std::filesystem::path sequence;
  DatasetOptions options;    ///< With the calibration that the run ended with.
  PinholeIntrinsics camera;  ///< Of the rectified images, as estimated.
};

/// Throws Error if the folder holds no finished run.
FinishedRun read_finished_run(const std::filesystem::path& folder);

/// The sequence that was run, played as then. Throws Error if it is not where it was.
std::unique_ptr<Dataset> open_sequence(const FinishedRun& run);

}  // namespace ldso
