#pragma once
// The map of a finished run, and images of it, for programs that learn scenes: a model of COLMAP and transforms.json.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "imagery/placed_map.h"
#include "imagery/posed_frames.h"
#include "ldso/io/colmap_model.h"
#include "output/finished_run.h"

namespace ldso {

/// Which images a model is made for.
enum class ColmapImages {
  kRectified,  ///< Pinhole images, which every program reads, a rolling shutter undone.
  kOriginal,   ///< As the camera took them, with its lens.
  kNone,       ///< Rectified, but not written.
};

/// What is exported, and how.
struct ColmapOptions {
  ColmapImages images = ColmapImages::kRectified;
  /// So many frames, sharp ones spread over the way of the camera; none: the keyframes.
  std::optional<int> count = std::nullopt;
};

/// Of the keyframes.
std::vector<FramePose> keyframes_of(const PlacedMap& placed);

/// A model with an image for each frame, which are in the order of their ids, without having seen one: a point is seen
/// by the frames from the first to the last keyframe that shared the window with its own, where it projects into them.
/// `camera`: of the images; `names`: theirs.
ColmapModel predicted_colmap_model(const PlacedMap& placed, const std::vector<FramePose>& frames,
                                   const CameraCalibration& camera, const std::vector<std::string>& names);

/// Writes sparse/0/ and points.ply and, but for kNone, images/ and transforms.json below `folder`. `trajectory`: of all
/// frames, placed as the map. Returns what whoever uses it should know. Throws Error if an image cannot be read or a
/// file not be written, or if frames are to be chosen without images.
std::vector<std::string> export_colmap(const std::filesystem::path& folder, const FinishedRun& run,
                                       const PlacedMap& placed, const Trajectory& trajectory,
                                       const ColmapOptions& options);

}  // namespace ldso
