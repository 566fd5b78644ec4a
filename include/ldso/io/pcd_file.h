#pragma once

#include <filesystem>
#include <vector>

#include "ldso/io/ply_file.h"

namespace ldso {

/// Binary PCD 0.7, the format of the Point Cloud Library: x y z intensity idepth_stddev, all float (intensity 0..255).
/// Throws Error if the file cannot be written.
void write_pcd(const std::filesystem::path& path, const std::vector<PlyPoint>& points);

}  // namespace ldso
