#include "calibration/lens/lens_calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/calib3d.hpp>

#include "calibration/board/test_board_picture.h"
#include "calibration/lens/advice.h"
#include "calibration/lens/calibration_pictures.h"
#include "calibration/lens/calibration_report.h"
#include "calibration/lens/view_choice.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

CameraCalibration camera_with(CameraModelKind model, double focal, std::array<double, 4> distortion, double k3 = 0) {
  CameraCalibration camera;
  camera.model = model;
  camera.width = 480;
  camera.height = 360;
  camera.fx = focal;
  camera.fy = 1.004 * focal;
  camera.cx = 243.7;
  camera.cy = 175.2;
  camera.distortion = distortion;
  camera.more_distortion[0] = k3;
  return camera;
}

std::vector<BoardView> rendered_views(const Board& board, const CameraCalibration& camera, int count,
                                      std::uint32_t seed = 1) {
  const auto model = make_camera_model(camera);
  const BoardPainter painter(board, *model);
  std::vector<BoardView> views;
  const std::vector<SE3d> poses = painter.poses(count, seed);
  for (int i = 0; i < count; ++i) {
    const auto seen = static_cast<std::uint32_t>(i) + 100 * seed;
    const Image<float> image = painter.paint(poses[static_cast<std::size_t>(i)], {.seed = seen});
    std::vector<SeenPoint> points = find_board(image.view(), board);
    if (!points.empty()) views.push_back({i, std::to_string(i), std::move(points)});
  }
  return views;
}

/// The truth in the order of lens_parameter_names().
Eigen::VectorXd parameters_of(const CameraCalibration& camera, LensKind kind) {
  Eigen::VectorXd p(static_cast<Eigen::Index>(lens_parameter_names(kind).size()));
  p.head<4>() << camera.fx, camera.fy, camera.cx, camera.cy;
  for (Eigen::Index i = 4; i < p.size(); ++i)
    p[i] = i < 8 ? camera.distortion[static_cast<std::size_t>(i - 4)] : camera.more_distortion[0];
  return p;
}

void expect_found(const char* board_text, const CameraCalibration& camera, LensKind kind, int count) {
  SCOPED_TRACE(std::string(board_text) + " " + lens_name(kind));
  const Board board = parse_board(board_text, "");
  const std::vector<BoardView> views = rendered_views(board, camera, count);
  const LensCalibration lens = calibrate_lens(views, board, kind, camera.width, camera.height, "views");
  const Eigen::VectorXd truth = parameters_of(camera, kind);
  EXPECT_NEAR(lens.parameters[0] / truth[0], 1, 0.001);
  EXPECT_NEAR(lens.parameters[1] / truth[1], 1, 0.001);
  ASSERT_EQ(lens.deviations.size(), truth.size());
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    EXPECT_LE(std::abs(lens.parameters[i] - truth[i]), 3 * lens.deviations[i])
        << lens_parameter_names(kind)[static_cast<std::size_t>(i)];
  }
  EXPECT_LT(lens.deviations[0], 0.001 * truth[0]);
  EXPECT_LT(lens.rms, 0.1);
  EXPECT_TRUE(lens.refused_views.empty());
}

TEST(LensCalibration, FindsRadTanFromAChessboard) {
  expect_found("chessboard:9x6:0.025", camera_with(CameraModelKind::kRadTan, 390, {-0.25, 0.08, 0.0006, -0.0004}),
               LensKind::kRadTan, 12);
}

TEST(LensCalibration, FindsFovFromCharuco) {
  expect_found("charuco:6x5:0.04:0.028", camera_with(CameraModelKind::kFov, 230, {0.92, 0, 0, 0}), LensKind::kFov, 24);
}

TEST(LensCalibration, FindsK3FromAnAprilGrid) {
  expect_found("aprilgrid:5x4:0.03", camera_with(CameraModelKind::kRadTan, 340, {-0.3, 0.12, 0.0006, -0.0004}, -0.025),
               LensKind::kRadTanK3, 12);
}

TEST(LensCalibration, FindsKannalaBrandtFromAChessboard) {
  expect_found("chessboard:9x6:0.025",
               camera_with(CameraModelKind::kKannalaBrandt, 190, {-0.02, 0.008, -0.004, 0.0007}),
               LensKind::kKannalaBrandt, 12);
}

/// Their centroids are a quarter of a pixel beside their centres here.
TEST(LensCalibration, FindsPinholeFromCircles) {
  expect_found("circles:4x11:0.02", camera_with(CameraModelKind::kPinhole, 430, {}), LensKind::kPinhole, 12);
}

TEST(LensCalibration, ChoosesTheModelAndTellsWhatIsMissing) {
  const CameraCalibration camera = camera_with(CameraModelKind::kFov, 230, {0.92, 0, 0, 0});
  const Board board = parse_board("aprilgrid:5x4:0.03", "");
  std::vector<BoardView> views = rendered_views(board, camera, 8);
  std::vector<LensCalibration> others;
  const LensCalibration lens = calibrate_best_lens(views, board, 480, 360, "views", &others);
  EXPECT_EQ(lens.kind, LensKind::kFov);
  EXPECT_GE(others.size(), 4u);  // A pinhole explains nothing here, and may be refused.
  EXPECT_EQ(draw_coverage(lens).width(), 480);
  EXPECT_EQ(draw_residuals(lens).height(), 360);
  EXPECT_NE(calibrated_camera_text(lens, 240).find("\ncrop\n240 180\n"), std::string::npos);

  for (BoardView& view : views) std::erase_if(view.points, [](const SeenPoint& p) { return p.pixel.x() < 165; });
  std::erase_if(views, [](const BoardView& view) { return view.points.size() < 8; });
  const auto advice = calibration_advice(calibrate_lens(views, board, LensKind::kFov, 480, 360, "views"));
  const auto is_about_left = [](const std::string& line) { return line.starts_with("No views in the left third"); };
  EXPECT_TRUE(std::any_of(advice.begin(), advice.end(), is_about_left));
}

TEST(LensCalibration, RefusesWrongPointsAndViews) {
  const CameraCalibration camera = camera_with(CameraModelKind::kRadTan, 390, {-0.25, 0.08, 0.0006, -0.0004});
  const Board board = parse_board("aprilgrid:5x4:0.03", "");
  std::vector<BoardView> views = rendered_views(board, camera, 8);
  views[2].points[3].pixel.x() += 4;
  for (std::size_t i = 0; i < views[5].points.size(); i += 2)
    views[5].points[i].pixel.y() += 5 + static_cast<double>(i % 3);
  const LensCalibration lens = calibrate_lens(views, board, LensKind::kRadTan, 480, 360, "views");
  EXPECT_EQ(lens.refused_views, std::vector<std::string>{views[5].name});
  EXPECT_GE(lens.refused_points, 1);
  EXPECT_NEAR(lens.camera.fx / camera.fx, 1, 0.002);
}

TEST(LensCalibration, RefusesTooFewViewsAndAnotherBoard) {
  const CameraCalibration camera = camera_with(CameraModelKind::kPinhole, 430, {});
  const Board board = parse_board("chessboard:9x6:0.025", "");
  std::vector<BoardView> views = rendered_views(board, camera, 4);
  EXPECT_THROW(calibrate_lens({views[0], views[1]}, board, LensKind::kPinhole, 480, 360, "views"), Error);
  EXPECT_THROW(calibrate_lens(views, parse_board("chessboard:6x9:0.025", ""), LensKind::kPinhole, 480, 360, "views"),
               Error);
}

TEST(ViewChoice, TakesWhatIsNewAndStill) {
  const Board board = parse_board("chessboard:3x3:1", "");
  const auto view_at = [](int frame, double x, double y) {
    MovingView moving{{frame, "", {}}, 0};
    for (int i = 0; i < 9; ++i) moving.view.points.push_back({i, {x + 10 * (i % 3), y + 10 * (i / 3)}, 0});
    return moving;
  };
  std::vector<MovingView> views{view_at(0, 20, 20), view_at(1, 21, 20), view_at(2, 400, 300), view_at(3, 20, 20)};
  views[0].pixels_per_frame = views[1].pixels_per_frame = 5;
  const std::vector<BoardView> chosen = choose_views(views, board, 480, 360, 4);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].frame, 2);
  EXPECT_EQ(chosen[1].frame, 3);
  EXPECT_NEAR(*motion_between(views[0].view.points, views[1].view.points), 1, 1e-9);
  EXPECT_FALSE(motion_between(views[0].view.points, {}));
}

/// OpenCV's own calibration images, where its documentation is installed.
TEST(LensCalibration, AgreesWithOpenCvOnItsImages) {
  const std::filesystem::path folder = "/usr/share/doc/opencv-doc/examples/data";
  if (!std::filesystem::exists(folder / "left01.jpg")) GTEST_SKIP() << "opencv-doc is not installed";
  const Board board = parse_board("chessboard:9x6:1", "");
  std::vector<BoardView> views;
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (int i = 1; i <= 14; ++i) {
    const std::filesystem::path file = folder / ((i < 10 ? "left0" : "left") + std::to_string(i) + ".jpg");
    if (!std::filesystem::exists(file)) continue;
    views.push_back({i, file.filename().string(), find_board(read_grey_image(file).view(), board)});
    ASSERT_EQ(views.back().points.size(), 54u) << file;
    objects.emplace_back();
    pixels.emplace_back();
    for (const SeenPoint& p : views.back().points) {
      objects.back().emplace_back(static_cast<float>(p.id % 9), static_cast<float>(p.id / 9), 0.F);
      pixels.back().emplace_back(static_cast<float>(p.pixel.x()), static_cast<float>(p.pixel.y()));
    }
  }
  const LensCalibration lens = calibrate_lens(views, board, LensKind::kRadTanK3, 640, 480, "views");
  cv::Mat K, D, rotations, translations;
  const double rms = cv::calibrateCamera(objects, pixels, {640, 480}, K, D, rotations, translations);
  EXPECT_NEAR(lens.camera.fx / K.at<double>(0, 0), 1, 0.002);
  EXPECT_NEAR(lens.camera.fy / K.at<double>(1, 1), 1, 0.002);
  EXPECT_LE(lens.rms, rms + 1e-6);
  EXPECT_LT(lens.rms, 0.2);  // Of the corners that OpenCV itself finds, it is 0.41.
}

}  // namespace
}  // namespace ldso
