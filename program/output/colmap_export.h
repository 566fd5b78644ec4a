#pragma once
// The map of a finished run as a model of COLMAP.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ldso/io/colmap_model.h"
#include "output/finished_run.h"
#include "viewer/recording/recorded_map.h"

namespace ldso {

/// Which images the model is made for.
enum class ColmapImages {
  kRectified,  ///< Pinhole images, which every program reads.
  kOriginal,   ///< As the camera took them, with its lens.
  kNone,       ///< Rectified, but not written.
};

/// Where the keyframes are, and with which points.
struct PlacedMap {
  const RecordedMap& map;
  std::vector<Sim3d> poses;     ///< Of its keyframes.
  double most_deviation = 1e9;  ///< Points whose inverse depth is less certain are left out (relative).
};

/// A model with an image for each keyframe. A point is seen by its own keyframe and by those that shared the window
/// with it, where it projects into them. `camera`: of the images; `names`: theirs, in the order of the keyframes.
ColmapModel make_colmap_model(const PlacedMap& placed, const CameraCalibration& camera,
                              const std::vector<std::string>& names);

/// Writes sparse/0/ and, but for kNone, images/ below `folder`. Throws Error if an image cannot be read or a file not
/// be written.
void export_colmap(const std::filesystem::path& folder, const FinishedRun& run, const PlacedMap& placed,
                   ColmapImages images);

}  // namespace ldso
