#include "io/calibration/foreign_writer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/datasets/test_sequences.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

CameraCalibration camera_of(CameraModelKind model, std::array<double, 4> distortion, std::array<double, 4> more = {}) {
  CameraCalibration camera;
  camera.model = model;
  camera.width = 752;
  camera.height = 480;
  camera.fx = 458.654 + 1 / 3.0;
  camera.fy = 457.296;
  camera.cx = 367.215;
  camera.cy = 248.375;
  camera.distortion = distortion;
  camera.more_distortion = more;
  return camera;
}

const std::vector<CameraCalibration>& cameras() {
  static const std::vector<CameraCalibration> all{
      camera_of(CameraModelKind::kPinhole, {}),
      camera_of(CameraModelKind::kRadTan, {-0.28, 0.07, 2e-4, -1.7e-5}),
      camera_of(CameraModelKind::kRadTan, {-0.28, 0.07, 2e-4, -1.7e-5}, {0.011, 0, 0, 0}),
      camera_of(CameraModelKind::kRadTan, {0.2, 0.05, 2e-4, -1.7e-5}, {0.011, 0.3, 0.02, 0.001}),
      camera_of(CameraModelKind::kKannalaBrandt, {0.003, 7e-4, -2e-3, 2e-4}),
      camera_of(CameraModelKind::kFov, {0.9}),
      camera_of(CameraModelKind::kDoubleSphere, {-0.17, 0.59}),
      camera_of(CameraModelKind::kEucm, {0.6, 1.1})};
  return all;
}

const ForeignFormat& format_named(const std::string& name) {
  return *std::find_if(kForeignFormats.begin(), kForeignFormats.end(),
                       [&](const ForeignFormat& format) { return name == format.name; });
}

/// Cameras, by their place above, that a format can hold.
struct Holds {
  const char* format;
  std::vector<int> cameras;
};

TEST(ForeignWriter, WhatIsWrittenReadsAsItWas) {
  const TemporaryFolder folder;
  const std::vector<Holds> all{{"kalibr", {0, 1, 4, 5, 6, 7}},    {"ros", {0, 1, 2, 3, 4}},
                               {"opencv", {0, 1, 2, 3, 4}},       {"colmap-camera", {0, 1, 2, 3, 4, 5}},
                               {"basalt", {0, 1, 2, 3, 4, 6, 7}}, {"nerfstudio", {0, 1, 2, 4}}};
  for (const Holds& holds : all) {
    const ForeignFormat& format = format_named(holds.format);
    for (int i = 0; i < static_cast<int>(cameras().size()); ++i) {
      const CameraCalibration& camera = cameras()[static_cast<std::size_t>(i)];
      const bool is_held = std::count(holds.cameras.begin(), holds.cameras.end(), i) > 0;
      SCOPED_TRACE(std::string(format.name) + ", camera " + std::to_string(i));
      if (!is_held) {
        EXPECT_THROW(format.write(camera), Error);
        continue;
      }
      write_text(folder / format.file, format.write(camera));
      const CameraCalibration read = read_camera_calibration(folder / format.file).camera;
      EXPECT_EQ(read.model, camera.model);
      EXPECT_EQ(read.width, camera.width);
      EXPECT_EQ(read.height, camera.height);
      EXPECT_NEAR(read.fx, camera.fx, 1e-9);
      EXPECT_NEAR(read.fy, camera.fy, 1e-9);
      EXPECT_NEAR(read.cx, camera.cx, 1e-9);
      EXPECT_NEAR(read.cy, camera.cy, 1e-9);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(read.distortion[k], camera.distortion[k], 1e-12);
        EXPECT_NEAR(read.more_distortion[k], camera.more_distortion[k], 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace ldso
