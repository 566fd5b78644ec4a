#pragma once
// A finished run as its folder tells of it: what was played, with which camera.

#include <filesystem>
#include <memory>
#include <optional>

#include "ldso/io/dataset.h"

namespace ldso {

struct FinishedRun {
  std::filesystem::path folder;
  std::filesystem::path sequence;
  DatasetOptions options;    ///< With the calibration that the run ended with.
  PinholeIntrinsics camera;  ///< Of the rectified images, as estimated.
  /// As the run ended with it; runs of older versions do not say.
  std::optional<CameraCalibration> lens = std::nullopt;
  std::size_t own_maps = 0;    ///< Parts that no loop joined to the main one.
  double metres_per_unit = 1;  ///< By which the recording, in the units of the run, becomes what its results are in.
};

/// Throws Error if the folder holds no finished run.
FinishedRun read_finished_run(const std::filesystem::path& folder);

/// The sequence that was run, played as then. Throws Error if it is not where it was.
std::unique_ptr<Dataset> open_sequence(const FinishedRun& run);

}  // namespace ldso
