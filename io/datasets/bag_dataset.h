#pragma once

#include <filesystem>
#include <memory>

#include "io/bags/bag.h"
#include "ldso/io/dataset.h"

namespace ldso {

// The images of a topic of a ROS bag, at the times of their headers, with the camera_info beside them.

/// Opens it; only the options topic, calibration_file and fps are used, and `end`, beyond which nothing is looked
/// through. Throws Error; one that lists the topics with images if there are several and none is chosen.
std::unique_ptr<Dataset> open_bag_dataset(const std::filesystem::path& path, const DatasetOptions& options);

}  // namespace ldso
