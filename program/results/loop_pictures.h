#pragma once
// Pictures of the accepted loops: both keyframes beside each other with the points that closed the loop.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ldso/io/dataset.h"
#include "ldso/records.h"
#include "ldso/settings.h"

namespace ldso {

/// In the folder of a run.
inline constexpr const char* kLoopPictureFolder = "loops/";

/// Writes loops/<keyframe>_<candidate>.png below `folder` for each accepted loop: the candidate on the left, the
/// keyframe on the right, rectified. Their images are read once more from `dataset`, which must be played as it was
/// for the run; `calibration` and `photometry` are those of the run. Returns why pictures are missing, one text for
/// each.
std::vector<std::string> write_loop_pictures(const std::filesystem::path& folder, std::span<const LoopRecord> loops,
                                             const Dataset& dataset, const Calibration& calibration,
                                             const PhotometrySettings& photometry);

/// One of them for a report.
struct LoopPicture {
  std::string caption;
  std::vector<std::uint8_t> jpeg;
};
struct LoopPictures {
  std::vector<LoopPicture> pictures;
  std::vector<std::string> problems;  ///< Why pictures are missing.
};

/// The same pictures, small and without their captions, of the loops with these indices. None is added once they have
/// `most_bytes` together.
LoopPictures make_loop_pictures(std::span<const LoopRecord> loops, std::span<const std::size_t> shown,
                                const Dataset& dataset, const Calibration& calibration,
                                const PhotometrySettings& photometry, std::size_t most_bytes);

/// Removes what write_loop_pictures() wrote there in an earlier run, and nothing else. Throws nothing.
void remove_loop_pictures(const std::filesystem::path& folder);

/// What stands below the picture.
std::string loop_caption(const LoopRecord& loop);

}  // namespace ldso
