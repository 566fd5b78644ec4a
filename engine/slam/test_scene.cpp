#include "slam/test_scene.h"

#include <array>
#include <cmath>

namespace ldso {
namespace {

constexpr double kFocal = 250;
constexpr double kStep = 0.02;                           // [m]
constexpr std::array<double, 3> kBoards{4.0, 2.0, 3.0};  // Distances [m], from top to bottom of the image.

double corner_value(int x, int y, int board) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 374761393u + static_cast<std::uint32_t>(y) * 668265263u +
                    static_cast<std::uint32_t>(board) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffu) / 65535.0;
}

/// Value noise: random values at the corners of a grid, smoothly interpolated.
double texture(double x, double y, int board) {
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(x - x0);
  const double b = ease(y - y0);
  const double top = (1 - a) * corner_value(x0, y0, board) + a * corner_value(x0 + 1, y0, board);
  const double bottom = (1 - a) * corner_value(x0, y0 + 1, board) + a * corner_value(x0 + 1, y0 + 1, board);
  return (1 - b) * top + b * bottom;
}

}  // namespace

Calibration scene_calibration() {
  Calibration calibration;
  calibration.camera.width = kSceneWidth;
  calibration.camera.height = kSceneHeight;
  calibration.camera.fx = calibration.camera.fy = kFocal;
  calibration.camera.cx = (kSceneWidth - 1) / 2.0;
  calibration.camera.cy = (kSceneHeight - 1) / 2.0;
  calibration.description = "drawn";
  return calibration;
}

Image<std::uint8_t> draw_scene(int frame) {
  Image<std::uint8_t> image(kSceneWidth, kSceneHeight);
  for (int v = 0; v < kSceneHeight; ++v) {
    const int board = 3 * v / kSceneHeight;
    const double z = kBoards[static_cast<std::size_t>(board)];
    const double cells_per_metre = 20.0 / z;  // A cell covers 12.5 pixels.
    for (int u = 0; u < kSceneWidth; ++u) {
      const double x = cells_per_metre * (kStep * frame + z * (u - (kSceneWidth - 1) / 2.0) / kFocal);
      const double y = cells_per_metre * z * (v - (kSceneHeight - 1) / 2.0) / kFocal;
      const double grey = 0.7 * texture(x, y, board) + 0.3 * texture(3 * x, 3 * y, board);
      image(u, v) = static_cast<std::uint8_t>(std::lround(20 + 215 * grey));
    }
  }
  return image;
}

RawFrame raw_frame(std::int64_t id, const Image<std::uint8_t>& image) {
  RawFrame raw;
  raw.id = id;
  raw.timestamp = 0.1 * static_cast<double>(id);
  raw.grey = Image<float>(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) raw.grey.data()[i] = static_cast<float>(image.data()[i]);
  return raw;
}

}  // namespace ldso
