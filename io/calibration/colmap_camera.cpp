#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "io/calibration/foreign_camera.h"
#include "io/calibration/lens.h"
#include "io/text/text_file.h"

namespace ldso {
namespace {

/// COLMAP's pixel centres are at 0.5.
constexpr double kHalfAPixel = 0.5;

struct ColmapLens {
  const char* name;
  std::size_t focal_lengths;
};

constexpr std::array<ColmapLens, 10> kColmapLenses{{{"SIMPLE_PINHOLE", 1},
                                                    {"PINHOLE", 2},
                                                    {"SIMPLE_RADIAL", 1},
                                                    {"RADIAL", 1},
                                                    {"OPENCV", 2},
                                                    {"FULL_OPENCV", 2},
                                                    {"OPENCV_FISHEYE", 2},
                                                    {"SIMPLE_RADIAL_FISHEYE", 1},
                                                    {"RADIAL_FISHEYE", 1},
                                                    {"FOV", 2}}};

/// "1 OPENCV 640 480 ...": a number, capitals, numbers.
bool is_camera_line(const TextLine& line) {
  double number = 0;
  if (line.fields.size() < 6 || !parse_number(line.fields[0], number) || !parse_number(line.fields[2], number))
    return false;
  const std::string& name = line.fields[1];
  return std::all_of(name.begin(), name.end(), [](char c) { return c == '_' || (c >= 'A' && c <= 'Z'); });
}

}  // namespace

bool is_colmap_cameras(const std::filesystem::path& path) {
  const TextFile file(path);
  return !file.lines().empty() && is_camera_line(file.lines().front());
}

ForeignCamera read_colmap_camera(const std::filesystem::path& path, int camera) {
  const TextFile file(path);
  check_camera(camera, static_cast<int>(file.lines().size()), path.string());
  const TextLine& line = file.lines()[static_cast<std::size_t>(camera)];
  if (!is_camera_line(line)) file.fail(line, "is no camera", "expected `CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]`");
  const std::string& name = line.fields[1];
  const auto lens = std::find_if(kColmapLenses.begin(), kColmapLenses.end(),
                                 [&](const ColmapLens& known) { return name == known.name; });
  if (lens == kColmapLenses.end()) {
    file.fail(line, "the camera model '" + name + "' is unknown here",
              "SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV, OPENCV_FISHEYE and FOV are known");
  }
  std::vector<double> numbers;
  for (std::size_t i = 2; i < line.fields.size(); ++i) numbers.push_back(file.finite_number(line, i));
  const std::size_t centre = 2 + lens->focal_lengths;
  if (numbers.size() < centre + 2)
    file.fail(line, "has " + std::to_string(line.fields.size()) + " columns",
              "expected `CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]`");
  ForeignCamera result;
  result.kind = "COLMAP cameras, " + name;
  result.where = path.string() + ":" + std::to_string(line.number);
  result.cameras = static_cast<int>(file.lines().size());
  set_size(result.camera, numbers[0], numbers[1], result.where);
  set_intrinsics(result.camera, numbers[2], numbers[centre - 1], numbers[centre] - kHalfAPixel,
                 numbers[centre + 1] - kHalfAPixel, result.where);
  set_lens(result.camera, name, {numbers.begin() + static_cast<std::ptrdiff_t>(centre) + 2, numbers.end()},
           result.where);
  return result;
}

}  // namespace ldso
