#include "image/rectifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "geometry/camera_model.h"
#include "image/masked_image.h"

namespace ldso {
namespace {

// What the scene looks like on the plane z = 1.
double scene(double x, double y) { return 120 + 60 * std::sin(5 * x + 1) + 40 * std::cos(6 * y - 2 * x); }

CameraCalibration camera_of(CameraModelKind model) {
  CameraCalibration camera;
  camera.model = model;
  camera.width = 645;
  camera.height = 483;
  camera.fx = 390;
  camera.fy = 395;
  camera.cx = 330.5;
  camera.cy = 235.25;
  if (model == CameraModelKind::kFov) camera.distortion = {0.85};
  if (model == CameraModelKind::kRadTan) camera.distortion = {-0.28, 0.07, 2e-4, 1e-3};
  if (model == CameraModelKind::kKannalaBrandt) camera.distortion = {0.003, 0.0007, -0.002, 0.0002};
  return camera;
}

/// The image the camera takes of the scene.
Image<float> photograph(const CameraCalibration& calibration) {
  const auto model = make_camera_model(calibration);
  Image<float> image(calibration.width, calibration.height);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::optional<Eigen::Vector3d> ray = model->unproject({x, y});
      image(x, y) = ray ? static_cast<float>(scene(ray->x(), ray->y())) : 0.0f;
    }
  }
  return image;
}

Rectification crop_to(int width, int height) {
  Rectification result;
  result.mode = RectificationMode::kCrop;
  result.width = width;
  result.height = height;
  return result;
}

Image<float> rectified(const Rectifier& rectifier, const Image<float>& input) {
  Image<float> output(rectifier.output_camera().width, rectifier.output_camera().height, 1e9f);
  rectifier.apply(input.view(), output.view());
  return output;
}

class RectifierTest : public testing::TestWithParam<CameraModelKind> {};

TEST_P(RectifierTest, ShowsTheSceneAsAPinholeCameraDoes) {
  const CameraCalibration camera = camera_of(GetParam());
  const Image<float> input = photograph(camera);
  for (const auto& [width, height] : {std::pair{0, 0}, std::pair{500, 301}, std::pair{160, 120}}) {
    const Rectifier rectifier(camera, crop_to(width, height));
    const PinholeIntrinsics& pinhole = rectifier.output_camera();
    const Image<float> output = rectified(rectifier, input);
    // Averaging 2 x 2 pixels blurs a little, and a halved image ends before the outermost pixels do.
    const bool halves = width == 160;
    const int border = halves ? 2 : 0;
    for (int y = border; y < output.height() - border; ++y) {
      for (int x = border; x < output.width() - border; ++x) {
        const double expected = scene((x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy);
        ASSERT_FALSE(is_marked(output(x, y))) << x << " " << y;
        ASSERT_NEAR(output(x, y), expected, halves ? 0.4 : 0.03) << x << " " << y;
      }
    }
  }
}

TEST_P(RectifierTest, FullMarksExactlyWhatIsOutside) {
  const CameraCalibration camera = camera_of(GetParam());
  const auto model = make_camera_model(camera);
  Rectification wanted;
  wanted.mode = RectificationMode::kExplicit;
  wanted.explicit_intrinsics = {0, 0, 200, 200, 322, 241};
  const Rectifier rectifier(camera, wanted);
  const Image<float> output = rectified(rectifier, Image<float>(camera.width, camera.height, 100.0f));
  int outside = 0;
  for (int y = 0; y < output.height(); ++y) {
    for (int x = 0; x < output.width(); ++x) {
      const Eigen::Vector2d px = model->project({(x - 322) / 200.0, (y - 241) / 200.0, 1});
      const bool inside = px.x() >= 0 && px.y() >= 0 && px.x() <= camera.width - 1 && px.y() <= camera.height - 1;
      ASSERT_EQ(is_marked(output(x, y)), !inside) << x << " " << y;
      if (inside) {
        ASSERT_EQ(output(x, y), 100.0f);
      }
      outside += !inside;
    }
  }
  EXPECT_GT(outside, 1000);
}

TEST_P(RectifierTest, MarksPixelsInterpolatedFromMarkedOnes) {
  const CameraCalibration camera = camera_of(GetParam());
  Image<float> input(camera.width, camera.height, 100.0f);
  input(200, 150) = mark_invalid(254.0f);
  const Rectifier rectifier(camera, crop_to(0, 0));
  const auto model = make_camera_model(camera);
  const PinholeIntrinsics& pinhole = rectifier.output_camera();
  const Image<float> output = rectified(rectifier, input);
  int marked = 0;
  for (int y = 0; y < output.height(); ++y) {
    for (int x = 0; x < output.width(); ++x) {
      const Eigen::Vector2d px = model->project({(x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy, 1});
      const bool touches = std::abs(px.x() - 200) < 1 && std::abs(px.y() - 150) < 1;
      ASSERT_EQ(is_marked(output(x, y)), touches) << x << " " << y;
      marked += touches;
    }
  }
  EXPECT_GT(marked, 0);
}

INSTANTIATE_TEST_SUITE_P(Models, RectifierTest,
                         testing::Values(CameraModelKind::kFov, CameraModelKind::kRadTan,
                                         CameraModelKind::kKannalaBrandt),
                         [](const auto& test) {
                           return std::string(test.param == CameraModelKind::kFov      ? "Fov"
                                              : test.param == CameraModelKind::kRadTan ? "RadTan"
                                                                                       : "KannalaBrandt");
                         });

TEST(Rectifier, LeavesAPinholeImageAlone) {
  const CameraCalibration camera = camera_of(CameraModelKind::kPinhole);
  const Image<float> input = photograph(camera);
  for (const auto mode : {RectificationMode::kNone, RectificationMode::kCrop, RectificationMode::kFull}) {
    Rectification wanted;
    wanted.mode = mode;
    const Rectifier rectifier(camera, wanted);
    EXPECT_TRUE(rectifier.is_identity());
    const Image<float> output = rectified(rectifier, input);
    for (std::size_t i = 0; i < input.size(); ++i) ASSERT_EQ(output.data()[i], input.data()[i]);
  }
}

TEST(Rectifier, ResizesAPinholeImage) {
  const CameraCalibration camera = camera_of(CameraModelKind::kPinhole);
  const Rectifier rectifier(camera, crop_to(323, 242));
  EXPECT_FALSE(rectifier.is_identity());
  const PinholeIntrinsics& pinhole = rectifier.output_camera();
  const Image<float> output = rectified(rectifier, photograph(camera));
  for (int y = 1; y < output.height() - 1; ++y) {
    for (int x = 1; x < output.width() - 1; ++x) {
      const double expected = scene((x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy);
      ASSERT_FALSE(is_marked(output(x, y)));
      ASSERT_NEAR(output(x, y), expected, 0.02);
    }
  }
}

// Stripes two pixels wide are finer than a quarter-size image can hold: they have to become grey, not coarse stripes.
TEST(Rectifier, DoesNotAliasWhenItShrinks) {
  const CameraCalibration camera = camera_of(CameraModelKind::kPinhole);
  Image<float> stripes(camera.width, camera.height);
  for (int y = 0; y < stripes.height(); ++y) {
    for (int x = 0; x < stripes.width(); ++x) stripes(x, y) = x % 4 < 2 ? 0.0f : 200.0f;
  }
  const Image<float> output = rectified(Rectifier(camera, crop_to(150, 112)), stripes);
  for (int y = 2; y < output.height() - 2; ++y) {
    for (int x = 2; x < output.width() - 2; ++x) ASSERT_NEAR(output(x, y), 100.0f, 1e-3);
  }
}

}  // namespace
}  // namespace ldso
