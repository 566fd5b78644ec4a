#pragma once
// The colours of the map's points, out of the images of their keyframes, which are read once more for them: tracking
// knows grey levels only.

#include <functional>
#include <string>
#include <vector>

#include "imagery/frame_images.h"
#include "viewer/recording/recorded_map.h"

namespace ldso {

/// Of points at `pixels`, the nearest pixel's; of those outside the nearest on the edge.
std::vector<Rgb> colors_at(const Image<Rgb>& image, const std::vector<Eigen::Vector2d>& pixels);

/// The recording of a run with the colours of its points; as it is if three of its keyframes have only grey ones.
/// Keyframes whose image cannot be read stay as they are, and `warn` hears of the first. `camera`: of the rectified
/// images, as estimated; `trajectory`: in the unit of the results, of which the recording's is `metres_per_unit`.
Bytes colored_recording(const Bytes& recording, const Dataset& sequence, const Calibration& calibration,
                        const PinholeIntrinsics& camera, const Trajectory& trajectory, double metres_per_unit,
                        const std::function<void(const std::string&)>& warn);

}  // namespace ldso
