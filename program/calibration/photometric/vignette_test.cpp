#include "calibration/photometric/vignette.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/board/test_board_picture.h"
#include "ldso/error.h"

namespace ldso {
namespace {

CameraCalibration wide_camera() {
  CameraCalibration camera;
  camera.model = CameraModelKind::kRadTan;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 240;
  camera.cx = 158;
  camera.cy = 121;
  camera.distortion = {-0.2, 0.05, 0, 0};
  return camera;
}

/// cos^4 of an angle, off the image's middle: a third is lost in the corners.
double vignette_at(double x, double y) { return std::pow(std::cos(std::atan(std::hypot(x - 170, y - 115) / 380)), 4); }

double exposure_of(int image) { return 0.8 + 0.05 * (image % 5); }

/// Views of a board on a grey wall, with other exposures for each.
std::vector<PlaneView> rendered_plane(const ObservedPlane& plane, const BoardPainter& painter, int count) {
  std::vector<PlaneView> views;
  const std::vector<SE3d> poses = painter.poses(count, 7);
  for (int i = 0; i < count; ++i) {
    const auto seed = static_cast<std::uint32_t>(i);
    Image<float> image = painter.paint(poses[seed], {.noise = 0.5, .seed = seed});
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x)
        image(x, y) = static_cast<float>(std::round(exposure_of(i) * vignette_at(x, y) * image(x, y)));
    }
    auto view = plane.view(image.view());
    if (!view) continue;
    view->exposure_ms = exposure_of(i);
    views.push_back(*view);
  }
  return views;
}

void expect_vignette(const std::vector<PlaneView>& views, const ObservedPlane& plane, bool exposures_known) {
  const VignetteEstimate estimate = estimate_vignette(views, plane.cells(), 320, 240, "views");
  EXPECT_EQ(estimate.exposures_known, exposures_known);
  EXPECT_GT(estimate.seen_share, 0.9);
  double sum = 0, worst = 0;
  for (int y = 0; y < 240; y += 4) {
    for (int x = 0; x < 320; x += 4) {
      const double error = std::abs(estimate.vignette(x, y) - vignette_at(x, y));
      sum += error / (60 * 80);
      worst = std::max(worst, error);
    }
  }
  EXPECT_LT(sum, 0.01);
  EXPECT_LT(worst, 0.05);
}

TEST(Vignette, IsFoundFromABoardOnAWall) {
  const Board board = parse_board("aprilgrid:3x3:0.03", "");
  const auto camera = make_camera_model(wide_camera());
  const BoardPainter painter(board, *camera);
  const ObservedPlane plane(board, *camera, std::nullopt);
  std::vector<PlaneView> views = rendered_plane(plane, painter, 24);
  ASSERT_GE(views.size(), 20u);
  expect_vignette(views, plane, true);
  for (PlaneView& view : views) view.exposure_ms.reset();
  expect_vignette(views, plane, false);
}

TEST(Vignette, RefusesFewViews) {
  EXPECT_THROW(estimate_vignette(std::vector<PlaneView>(5), 100, 320, 240, "views"), Error);
}

}  // namespace
}  // namespace ldso
