#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/bags/bag.h"
#include "ldso/calibration.h"

namespace ldso {

/// The calibration that a bag has of the camera whose images are on `topic`: that of the camera_info beside it, or, if
/// there is none, of the only one whose messages bear `frame` (the images' frame of coordinates). Of images on a topic
/// "image_rect...", the rectified camera. Nothing if there is none, or if it says that the camera was not calibrated;
/// then `warnings` has why. Throws Error if it makes no sense.
std::optional<Calibration> find_camera_info(const Bag& bag, const std::string& location, const std::string& topic,
                                            const std::string& frame, std::vector<std::string>& warnings);

/// "/camera/image_raw" of "/camera/image_raw/compressed".
std::string base_topic(const BagTopic& topic);

}  // namespace ldso
