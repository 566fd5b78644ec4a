#include "io/datasets/tum_rgbd_dataset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(TumRgbdDataset, CarriesGroundTruth) {
  const TemporaryFolder folder;
  const auto dataset = open_tum_rgbd(make_tum_rgbd(folder.path(), 4), {});
  ASSERT_TRUE(dataset->ground_truth().has_value());
  EXPECT_EQ(dataset->ground_truth()->at(2).T_world_camera.translation().x(), 2);
}

TEST(TumRgbdDataset, KnowsTheFreiburgCamerasByName) {
  EXPECT_EQ(freiburg_calibration("rgbd_dataset_freiburg1_xyz")->camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(freiburg_calibration("FR2_desk")->rectification.mode, RectificationMode::kCrop);
  EXPECT_EQ(freiburg_calibration("rgbd_dataset_freiburg3_long_office")->camera.fy, 539.2);
  EXPECT_EQ(freiburg_calibration("fr3_desk")->camera.model, CameraModelKind::kPinhole);
  EXPECT_FALSE(freiburg_calibration("my_room").has_value());
}

// The published calibration of the first camera, with its third radial coefficient.
Eigen::Vector2d published_freiburg1(double x, double y) {
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (0.262383 + r2 * (-0.953104 + r2 * 1.163314));
  return {517.306408 * (x * radial + 2 * -0.005358 * x * y + 0.002628 * (r2 + 2 * x * x)) + 318.643040,
          516.469215 * (y * radial + -0.005358 * (r2 + 2 * y * y) + 2 * 0.002628 * x * y) + 255.313989};
}

TEST(TumRgbdDataset, FreiburgParametersComeNearThePublishedMapping) {
  const CameraCalibration c = freiburg_calibration("fr1")->camera;
  double sum = 0;
  int count = 0;
  for (double y = -0.45; y <= 0.45; y += 0.05) {
    for (double x = -0.6; x <= 0.6; x += 0.05) {
      const auto [k1, k2, p1, p2] = c.distortion;
      const double r2 = x * x + y * y;
      const double radial = 1 + r2 * (k1 + r2 * k2);
      const Eigen::Vector2d pixel(c.fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + c.cx,
                                  c.fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + c.cy);
      sum += (pixel - published_freiburg1(x, y)).squaredNorm();
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(sum / count), 1.0);
}

TEST(TumRgbdDataset, WithoutCalibrationSaysWhatToDo) {
  const TemporaryFolder folder;
  make_tum_rgbd(folder.path(), 2);
  fs::remove(folder / "camera.txt");
  EXPECT_NE(error_of([&] { open_tum_rgbd(folder.path(), {}); }).find("--calib"), std::string::npos);
}

TEST(TumRgbdDataset, BadListOfImagesIsAnError) {
  const TemporaryFolder folder;
  make_tum_rgbd(folder.path(), 2);
  write_text(folder / "rgb.txt", "# timestamp filename\n0.1 rgb/0.png\nrgb/1.png\n");
  EXPECT_NE(error_of([&] { open_tum_rgbd(folder.path(), {}); }).find("rgb.txt:3"), std::string::npos);
}

}  // namespace
}  // namespace ldso
