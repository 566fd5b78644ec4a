// How a program uses the library: give it images one by one, ask for poses, take the map at the end. The images are
// drawn here: a camera moves sideways past three textured boards at different distances.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "ldso/error.h"
#include "ldso/slam.h"

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kFocal = 250;
constexpr int kFrames = 40;
constexpr double kStep = 0.02;  // [m] between frames

ldso::Calibration make_calibration() {
  ldso::Calibration calibration;
  calibration.camera.width = kWidth;
  calibration.camera.height = kHeight;
  calibration.camera.fx = calibration.camera.fy = kFocal;
  calibration.camera.cx = (kWidth - 1) / 2.0;
  calibration.camera.cy = (kHeight - 1) / 2.0;
  calibration.description = "drawn";
  return calibration;
}

// Value noise: random grey levels at the corners of a grid, smoothly interpolated.
double corner_value(int x, int y, int board) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 374761393u + static_cast<std::uint32_t>(y) * 668265263u +
                    static_cast<std::uint32_t>(board) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffu) / 65535.0;
}

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

// Boards at these distances [m], one above the other; seen from x = camera_x.
ldso::Image<std::uint8_t> draw(double camera_x) {
  constexpr std::array<double, 3> kDepths{4.0, 2.0, 3.0};
  ldso::Image<std::uint8_t> image(kWidth, kHeight);
  for (int v = 0; v < kHeight; ++v) {
    const int board = 3 * v / kHeight;
    const double z = kDepths[static_cast<std::size_t>(board)];
    for (int u = 0; u < kWidth; ++u) {
      const double x = camera_x + z * (u - (kWidth - 1) / 2.0) / kFocal;
      const double y = z * (v - (kHeight - 1) / 2.0) / kFocal;
      const double cells = 20.0 / z;  // a cell covers 12.5 pixels
      const double grey =
          0.7 * texture(cells * x, cells * y, board) + 0.3 * texture(3 * cells * x, 3 * cells * y, board);
      image(u, v) = static_cast<std::uint8_t>(std::lround(20 + 215 * grey));
    }
  }
  return image;
}

}  // namespace

int main() {
  try {
    ldso::Slam slam(make_calibration(), ldso::Settings{},
                    [](ldso::LogLevel, const std::string& message) { std::printf("%s\n", message.c_str()); });
    for (int i = 0; i < kFrames; ++i) {
      const ldso::Image<std::uint8_t> image = draw(kStep * i);
      slam.process(image.view(), 0.1 * i);
    }
    const ldso::SlamResult result = slam.finish();
    const auto poses = result.trajectory();
    std::printf("%zu of %d frames have a pose; %zu keyframes, %zu points\n", poses.size(), kFrames,
                result.keyframes.size(), result.points().size());
    if (poses.size() < kFrames / 2 || result.points().empty()) return 1;

    // The camera moved along x only: nothing else may show in the result.
    const Eigen::Vector3d way = poses.back().T_world_camera.translation() - poses.front().T_world_camera.translation();
    std::printf("direction of motion %.4f %.4f %.4f\n", way.x() / way.norm(), way.y() / way.norm(),
                way.z() / way.norm());
    return way.x() / way.norm() > 0.99 ? 0 : 1;
  } catch (const ldso::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
