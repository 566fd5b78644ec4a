#pragma once
// The poses and the camera of a model as transforms.json, which nerfstudio and instant-ngp read.

#include <filesystem>
#include <string>

#include "ldso/io/colmap_model.h"

namespace ldso {

/// Whether the format has a lens like that of the camera.
bool has_transforms_lens(const CameraCalibration& camera);

/// `images`, `cloud`: the folder of the images and the file of the points, from that of the file. Throws Error if it
/// cannot be written, or if the format has no such lens.
void write_transforms_json(const std::filesystem::path& path, const ColmapModel& model, const std::string& images,
                           const std::string& cloud);

}  // namespace ldso
