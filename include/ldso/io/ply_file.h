#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "ldso/rgb.h"

namespace ldso {

/// A point of a cloud as map.ply holds it.
struct PlyPoint {
  float x = 0, y = 0, z = 0;
  std::uint8_t intensity = 0;
  float idepth_stddev = 0;  ///< Standard deviation of the inverse depth in the host keyframe.
  std::optional<Rgb> color = std::nullopt;
};

/// Binary little-endian PLY: x y z, red green blue (the color, or the intensity, for viewers), intensity,
/// idepth_stddev. Throws Error if the file cannot be written.
void write_ply(const std::filesystem::path& path, const std::vector<PlyPoint>& points);

/// Reads what write_ply() wrote, no other PLY. Throws Error.
std::vector<PlyPoint> read_ply(const std::filesystem::path& path);

}  // namespace ldso
