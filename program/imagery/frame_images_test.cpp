#include "imagery/frame_images.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/pinhole_projection.h"
#include "geometry/rolling_shutter.h"

namespace ldso {
namespace {

const CameraCalibration kPictureCamera{CameraModelKind::kPinhole, 160, 120, 120, 120, 79.5, 59.5, {}};
const PinholeIntrinsics kPicturePinhole{160, 120, 120, 120, 79.5, 59.5};
constexpr double kWallDepth = 2;

/// Colours of a wall that change smoothly.
Rgb wall_color(double x, double y) {
  const auto level = [](double v) { return static_cast<std::uint8_t>(std::lround(128 + 100 * std::sin(v))); };
  return {level(8 * x), level(8 * y), level(6 * (x + y))};
}

SE3d pose_at(double seconds) {
  return SE3d::exp(seconds * (ReadoutMotion() << 3.2, 1.2, 0, 0.8, -1.6, 1.2).finished());
}

/// A camera with a rolling shutter of 30 ms in front of a wall in the plane z = 2, at 10 Hz.
class WallFilm final : public Dataset {
 public:
  explicit WallFilm(double readout_ms) {
    calibration_.camera = kPictureCamera;
    calibration_.camera.readout_ms = readout_ms;
  }
  int size() const override { return 3; }
  double timestamp(int index) const override { return 0.1 * index; }
  RawFrame read(int) const override { return {}; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "wall"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  Image<Rgb> read_color(int index) const override {
    Image<Rgb> image(kPicturePinhole.width, kPicturePinhole.height);
    for (int y = 0; y < image.height(); ++y) {
      const double late = 1e-3 * calibration_.camera.readout_ms * row_time(y, image.height());
      const SE3d T_w_c = pose_at(timestamp(index) + late).inverse();
      for (int x = 0; x < image.width(); ++x) {
        const Eigen::Vector3d ray = T_w_c.rotation() * viewing_ray(kPicturePinhole, Eigen::Vector2d(x, y));
        const Eigen::Vector3d p = T_w_c.translation() + (kWallDepth - T_w_c.translation().z()) / ray.z() * ray;
        image(x, y) = wall_color(p.x(), p.y());
      }
    }
    return image;
  }

 private:
  Calibration calibration_;
  std::vector<std::string> warnings_;
};

double difference(const Image<Rgb>& a, const Image<Rgb>& b) {
  constexpr int kBorder = 12;
  double sum = 0;
  int count = 0;
  for (int y = kBorder; y < a.height() - kBorder; ++y) {
    for (int x = kBorder; x < a.width() - kBorder; ++x, ++count) {
      for (std::size_t c = 0; c < 3; ++c) sum += std::abs(a(x, y)[c] - b(x, y)[c]) / 3.0;
    }
  }
  return sum / count;
}

/// Of the wall, as the keyframe in the middle has it.
RecordedMap wall_map() {
  protocol::Keyframe keyframe;
  keyframe.id = 1;
  keyframe.T_world_camera = pose_at(0.1).inverse();
  for (int y = 5; y < 120; y += 10) {
    for (int x = 5; x < 160; x += 10) {
      const SE3d& T = keyframe.T_world_camera;
      const Eigen::Vector3d ray = viewing_ray(kPicturePinhole, Eigen::Vector2d(x, y));
      const double depth = (kWallDepth - T.translation().z()) / (T.rotation() * ray).z();
      keyframe.points.emplace_back((depth * ray).cast<float>());
    }
  }
  RecordedMap map;
  map.keyframes.push_back(keyframe);
  map.corrected.emplace_back(keyframe.T_world_camera);
  return map;
}

TEST(FrameImages, ARollingShutterIsUndone) {
  const WallFilm film(30), still(0);
  const RecordedMap map = wall_map();
  const PlacedMap placed{map, map.corrected};
  std::vector<FramePose> frames;
  for (int i = 0; i < 3; ++i) frames.push_back({i, film.timestamp(i), pose_at(film.timestamp(i)).inverse()});
  const FrameImages images(film, film.calibration(), kPicturePinhole, placed, frames);
  ASSERT_TRUE(images.has_rolling_shutter());
  const Image<Rgb> truth = still.read_color(1);
  const double before = difference(images.rectified(1, false), truth),
               after = difference(images.rectified(1, true), truth);
  EXPECT_GT(before, 2);
  EXPECT_LT(after, 0.15 * before);
  const ShutterShift shift = images.shift(1);
  EXPECT_GT(shift.median, 0.2);
  EXPECT_LT(shift.largest, 8);
  EXPECT_LT(shift.median, shift.largest);
}

TEST(FrameImages, FramesWithoutAPoseStayAsTheyAre) {
  const WallFilm film(30);
  const RecordedMap map = wall_map();
  const PlacedMap placed{map, map.corrected};
  const FrameImages images(film, film.calibration(), kPicturePinhole, placed, {{1, 0.1, pose_at(0.1).inverse()}});
  EXPECT_EQ(difference(images.rectified(1, true), film.read_color(1)), 0);
  EXPECT_EQ(images.shift(2).largest, 0);
}

TEST(FrameImages, EachChannelIsRectifiedAndTheRestIsBlack) {
  CameraCalibration camera = kPictureCamera;
  camera.model = CameraModelKind::kRadTan;
  camera.distortion = {-0.3, 0.05, 0, 0};
  Rectification full;
  full.mode = RectificationMode::kFull;
  const Rectifier rectifier(camera, full);
  const Image<Rgb> image(camera.width, camera.height, Rgb{200, 100, 50});
  const Image<Rgb> bent = rectified(image, rectifier);
  ASSERT_EQ(bent.width(), rectifier.output_camera().width);
  EXPECT_EQ(bent(bent.width() / 2, bent.height() / 2), (Rgb{200, 100, 50}));
  EXPECT_EQ(bent(0, bent.height() / 2), (Rgb{0, 0, 0})) << "beside what the camera saw";
}

TEST(FrameImages, GreyIsNoColour) {
  Image<Rgb> image(4, 4, Rgb{9, 9, 9});
  EXPECT_FALSE(has_color(image));
  EXPECT_NEAR(to_grey(image)(1, 1), 9, 1e-5);
  image(3, 3) = {9, 9, 10};
  EXPECT_TRUE(has_color(image));
}

}  // namespace
}  // namespace ldso
