#include "ldso/io/ply_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr std::size_t kBytesPerPoint = 4 * sizeof(float) + 4;
constexpr std::string_view kBeforeCount =
    "ply\n"
    "format binary_little_endian 1.0\n"
    "comment intensity 0..255; idepth_stddev: standard deviation of the inverse depth\n"
    "element vertex ";
constexpr std::string_view kAfterCount =
    "\nproperty float x\n"
    "property float y\n"
    "property float z\n"
    "property uchar red\n"
    "property uchar green\n"
    "property uchar blue\n"
    "property uchar intensity\n"
    "property float idepth_stddev\n"
    "end_header\n";

void append_float(std::string& bytes, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xff);
}

float float_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{static_cast<std::uint8_t>(bytes[offset + i])} << 8 * i;
  return std::bit_cast<float>(bits);
}

void append_point(std::string& bytes, const PlyPoint& point) {
  append_float(bytes, point.x);
  append_float(bytes, point.y);
  append_float(bytes, point.z);
  const char grey = static_cast<char>(point.intensity);
  for (int i = 0; i < 3; ++i) bytes += point.color ? static_cast<char>((*point.color)[i]) : grey;
  bytes += grey;
  append_float(bytes, point.idepth_stddev);
}

PlyPoint point_at(std::string_view bytes, std::size_t offset) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[offset + i]); };
  PlyPoint point{float_at(bytes, offset), float_at(bytes, offset + 4), float_at(bytes, offset + 8), byte(15),
                 float_at(bytes, offset + 16)};
  const Rgb color{byte(12), byte(13), byte(14)}, grey{point.intensity, point.intensity, point.intensity};
  if (color != grey) point.color = color;
  return point;
}

bool is_finite(const PlyPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.idepth_stddev);
}

}  // namespace

void write_ply(const std::filesystem::path& path, const std::vector<PlyPoint>& points) {
  std::string bytes(kBeforeCount);
  bytes += std::to_string(points.size());
  bytes += kAfterCount;
  bytes.reserve(bytes.size() + points.size() * kBytesPerPoint);
  for (const PlyPoint& point : points) append_point(bytes, point);
  write_file(path, bytes);
}

std::vector<PlyPoint> read_ply(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::size_t end = bytes.find(kAfterCount);
  double count = 0;
  if (!bytes.starts_with(kBeforeCount) || end == std::string::npos ||
      !parse_number(std::string_view(bytes).substr(kBeforeCount.size(), end - kBeforeCount.size()), count)) {
    throw Error(path.string(), "is not a point cloud of this program", "see docs of map.ply");
  }
  const std::size_t first = end + kAfterCount.size();
  if (static_cast<double>(bytes.size() - first) != count * static_cast<double>(kBytesPerPoint)) {
    throw Error(path.string(), "has not the announced number of points", "the file is cut off; write it again");
  }
  std::vector<PlyPoint> points;
  for (std::size_t offset = first; offset < bytes.size(); offset += kBytesPerPoint)
    points.push_back(point_at(bytes, offset));
  if (!std::all_of(points.begin(), points.end(), is_finite))
    throw Error(path.string(), "has a point that is not finite", "the file is damaged; write it again");
  return points;
}

}  // namespace ldso
