#include "image/pinhole_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ldso/error.h"

namespace ldso {
namespace {

struct NamedCamera {
  std::string name;
  CameraCalibration camera;
};

CameraCalibration make_camera(CameraModelKind model, int width, int height, double fx, double fy, double cx, double cy,
                              std::array<double, 4> distortion) {
  CameraCalibration camera;
  camera.model = model;
  camera.width = width;
  camera.height = height;
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  camera.distortion = distortion;
  return camera;
}

std::vector<NamedCamera> distorted_cameras() {
  return {
      {"FovWide", make_camera(CameraModelKind::kFov, 640, 480, 224, 240, 318.5, 245.2, {0.93})},
      {"FovMild", make_camera(CameraModelKind::kFov, 641, 377, 500, 490, 310.5, 180.2, {0.5})},
      {"RadTanEuroc", make_camera(CameraModelKind::kRadTan, 752, 480, 458.654, 457.296, 367.215, 248.375,
                                  {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05})},
      {"RadTanPincushion",
       make_camera(CameraModelKind::kRadTan, 640, 480, 520, 521, 325, 250, {0.12, 0.02, 1e-3, -2e-3})},
      {"RadTanFolding", make_camera(CameraModelKind::kRadTan, 640, 480, 300, 300, 320, 240, {-0.3, 0.0, 0, 0})},
      {"KannalaBrandt", make_camera(CameraModelKind::kKannalaBrandt, 512, 512, 190.9, 190.9, 254.9, 256.9,
                                    {0.0034, 0.0007, -0.002, 0.0002})},
  };
}

Rectification rectification(RectificationMode mode, int width = 0, int height = 0) {
  Rectification result;
  result.mode = mode;
  result.width = width;
  result.height = height;
  return result;
}

Eigen::Vector2d plane_point(const PinholeIntrinsics& camera, double x, double y) {
  return {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy};
}

PinholeIntrinsics fit(const CameraCalibration& camera, const Rectification& wanted) {
  return fit_pinhole(camera, wanted, VisibleRegion(camera));
}

std::string error_of(const CameraCalibration& camera, const Rectification& wanted) {
  try {
    fit(camera, wanted);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class PinholeFitTest : public testing::TestWithParam<NamedCamera> {};

TEST_P(PinholeFitTest, CropShowsNothingButTheInput) {
  const CameraCalibration& camera = GetParam().camera;
  const VisibleRegion region(camera);
  for (const auto& [width, height] : {std::pair{0, 0}, std::pair{416, 128}, std::pair{101, 333}}) {
    const PinholeIntrinsics crop = fit_pinhole(camera, rectification(RectificationMode::kCrop, width, height), region);
    EXPECT_EQ(crop.width, width == 0 ? camera.width : width);
    EXPECT_EQ(crop.height, height == 0 ? camera.height : height);
    for (int y = 0; y < crop.height; ++y) {
      for (int x = 0; x < crop.width; ++x) {
        ASSERT_TRUE(region.contains(plane_point(crop, x, y))) << x << " " << y << " of " << width << " x " << height;
      }
    }
  }
}

TEST_P(PinholeFitTest, NoSideOfTheCropCanMoveOut) {
  const CameraCalibration& camera = GetParam().camera;
  const VisibleRegion region(camera);
  const PinholeIntrinsics crop = fit_pinhole(camera, rectification(RectificationMode::kCrop), region);
  const double limit = VisibleRegion::kMaxTangent;
  // On each side, one and a half pixels farther out, something is not visible (or too oblique).
  const auto blocked = [&](double x0, double y0, double x1, double y1) {
    for (int i = 0; i <= 2000; ++i) {
      const double t = i / 2000.0;
      const Eigen::Vector2d p = plane_point(crop, x0 + t * (x1 - x0), y0 + t * (y1 - y0));
      if (!region.contains(p) || p.cwiseAbs().maxCoeff() > limit) return true;
    }
    return false;
  };
  const double right = crop.width - 1, bottom = crop.height - 1, out = 1.5;
  EXPECT_TRUE(blocked(-out, 0, -out, bottom));
  EXPECT_TRUE(blocked(right + out, 0, right + out, bottom));
  EXPECT_TRUE(blocked(0, -out, right, -out));
  EXPECT_TRUE(blocked(0, bottom + out, right, bottom + out));
}

TEST_P(PinholeFitTest, FullShowsEveryInputPixelAndNoMore) {
  const CameraCalibration& camera = GetParam().camera;
  const VisibleRegion region(camera);
  if (GetParam().name == "FovWide" ||
      GetParam().name == "KannalaBrandt") {  // sees more than any pinhole image can show
    EXPECT_NE(error_of(camera, rectification(RectificationMode::kFull)).find("80 degrees"), std::string::npos);
    return;
  }
  const PinholeIntrinsics full = fit_pinhole(camera, rectification(RectificationMode::kFull), region);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto point = region.point({x, y});
      if (!point) continue;
      const double u = full.fx * point->x() + full.cx, v = full.fy * point->y() + full.cy;
      left = std::min(left, u);
      right = std::max(right, u);
      top = std::min(top, v);
      bottom = std::max(bottom, v);
    }
  }
  // Where the model ends inside of the image, the outermost points are looked for on a grid only.
  const double tolerance = GetParam().name == "RadTanFolding" ? 40 : 1e-6;
  EXPECT_NEAR(left, 0, tolerance);
  EXPECT_NEAR(top, 0, tolerance);
  EXPECT_NEAR(right, full.width - 1, tolerance);
  EXPECT_NEAR(bottom, full.height - 1, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Cameras, PinholeFitTest, testing::ValuesIn(distorted_cameras()),
                         [](const auto& test) { return test.param.name; });

double plane_area(const PinholeIntrinsics& camera) {
  return (camera.width - 1) / camera.fx * (camera.height - 1) / camera.fy;
}

// A lens whose visible region is convex: the best rectangle trades width against height. No rectangle on a grid of
// candidates, tested by brute force, is larger.
TEST(PinholeFit, CropIsTheLargestRectangle) {
  const CameraCalibration camera = distorted_cameras()[3].camera;
  const VisibleRegion region(camera);
  const double area = plane_area(fit_pinhole(camera, rectification(RectificationMode::kCrop), region));
  constexpr int kSteps = 40;
  const auto at = [](double from, double to, int i) { return from + (to - from) * i / kSteps; };
  double best = 0;
  for (int l = 0; l < kSteps; ++l) {
    for (int r = 0; r < kSteps; ++r) {
      for (int t = 0; t < kSteps; ++t) {
        for (int b = 0; b < kSteps; ++b) {
          const double left = at(-0.62, -0.5, l), right = at(0.5, 0.62, r);
          const double top = at(-0.48, -0.36, t), bottom = at(0.36, 0.48, b);
          const double candidate = (right - left) * (bottom - top);
          if (candidate <= best) continue;
          bool visible = true;
          for (int i = 0; i <= kSteps && visible; ++i) {
            visible = region.contains({at(left, right, i), top}) && region.contains({at(left, right, i), bottom}) &&
                      region.contains({left, at(top, bottom, i)}) && region.contains({right, at(top, bottom, i)});
          }
          if (visible) best = candidate;
        }
      }
    }
  }
  EXPECT_GT(best, 0.95 * area);  // the candidates do surround it
  EXPECT_GT(area, 0.998 * best);
}

TEST(PinholeFit, OfAPinholeIsThePinhole) {
  const CameraCalibration camera = make_camera(CameraModelKind::kPinhole, 641, 377, 500, 490, 310.5, 180.2, {});
  for (const auto mode : {RectificationMode::kNone, RectificationMode::kCrop, RectificationMode::kFull}) {
    const PinholeIntrinsics same = fit(camera, rectification(mode));
    EXPECT_EQ(same.width, 641);
    EXPECT_EQ(same.height, 377);
    EXPECT_EQ(same.fx, 500);
    EXPECT_EQ(same.fy, 490);
    EXPECT_EQ(same.cx, 310.5);
    EXPECT_EQ(same.cy, 180.2);
  }
  const PinholeIntrinsics half = fit(camera, rectification(RectificationMode::kCrop, 321, 189));
  EXPECT_NEAR(half.fx, 250, 1e-12);
  EXPECT_NEAR(half.cx, 155.25, 1e-12);
  EXPECT_NEAR(half.fy, 245, 1e-12);
  EXPECT_NEAR(half.cy, 90.1, 1e-12);
}

TEST(PinholeFit, KnowsAPinholeInDisguise) {
  CameraCalibration camera = make_camera(CameraModelKind::kFov, 640, 480, 500, 500, 320, 240, {});
  EXPECT_TRUE(is_pinhole(camera));
  EXPECT_EQ(fit(camera, rectification(RectificationMode::kNone)).fx, 500);
  camera.model = CameraModelKind::kRadTan;
  EXPECT_TRUE(is_pinhole(camera));
  camera.model = CameraModelKind::kKannalaBrandt;
  EXPECT_FALSE(is_pinhole(camera));
}

TEST(PinholeFit, TakesExplicitIntrinsicsAsTheyAre) {
  Rectification wanted = rectification(RectificationMode::kExplicit, 320, 200);
  wanted.explicit_intrinsics = {0, 0, 210, 211, 160.5, 99.25};
  const PinholeIntrinsics camera = fit(distorted_cameras()[0].camera, wanted);
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.height, 200);
  EXPECT_EQ(camera.fx, 210);
  EXPECT_EQ(camera.fy, 211);
  EXPECT_EQ(camera.cx, 160.5);
  EXPECT_EQ(camera.cy, 99.25);
  wanted.explicit_intrinsics.fy = 0;
  EXPECT_NE(error_of(distorted_cameras()[0].camera, wanted).find("focal"), std::string::npos);
}

TEST(PinholeFit, ExplainsWhatCannotBe) {
  const CameraCalibration distorted = distorted_cameras()[0].camera;
  const CameraCalibration pinhole = make_camera(CameraModelKind::kPinhole, 640, 480, 500, 500, 320, 240, {});
  EXPECT_NE(error_of(distorted, rectification(RectificationMode::kNone)).find("use crop"), std::string::npos);
  EXPECT_NE(error_of(pinhole, rectification(RectificationMode::kNone, 320, 240)).find("640 x 480 to 320 x 240"),
            std::string::npos);
  EXPECT_NE(error_of(pinhole, rectification(RectificationMode::kCrop, 1, 240)).find("1 x 240"), std::string::npos);
  CameraCalibration elsewhere = distorted_cameras()[4].camera;
  elsewhere.cx = 5000;  // the middle of the image is beyond the fold
  EXPECT_NE(error_of(elsewhere, rectification(RectificationMode::kCrop)).find("middle of the image"),
            std::string::npos);
}

}  // namespace
}  // namespace ldso
