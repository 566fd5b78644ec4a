#pragma once

#include <filesystem>
#include <optional>

#include "ldso/calibration.h"

namespace ldso {

// Calibrations that other programs wrote: Kalibr's camchain, ROS' camera_info, OpenCV's FileStorage (the calibration
// sample's, ORB-SLAM's settings), COLMAP's cameras.txt, Basalt's json, KITTI's calib_cam_to_cam.txt and calib.txt,
// nerfstudio's transforms.json. They say nothing of rectification: `crop` at the size of the images.

/// Nothing if the file is none of these, as far as can be seen. Throws Error naming the file, and the line where
/// there is one, if it is one of them but cannot be used. Of several cameras the first is taken, with a warning.
/// `camera` is another one, counted from 0.
std::optional<Calibration> read_foreign_calibration(const std::filesystem::path& path,
                                                    std::optional<int> camera = std::nullopt);

/// camera.txt in `folder`, or else a file by one of the names that other programs give; camera.txt if there is none.
std::filesystem::path find_calibration(const std::filesystem::path& folder);

}  // namespace ldso
