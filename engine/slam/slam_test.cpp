#include "ldso/slam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ldso/error.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 30;

template <class T>
Image<T> converted(const Image<std::uint8_t>& image, T factor) {
  Image<T> result(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) result.data()[i] = static_cast<T>(factor * image.data()[i]);
  return result;
}

SlamResult run(const Settings& settings, int frames = kFrames) {
  Slam slam(scene_calibration(), settings);
  for (int i = 0; i < frames; ++i) slam.process(draw_scene(i).view(), 0.1 * i);
  return slam.finish();
}

void expect_equal(const SlamResult& a, const SlamResult& b) {
  const auto poses_a = a.trajectory();
  const auto poses_b = b.trajectory();
  ASSERT_EQ(poses_a.size(), poses_b.size());
  for (std::size_t i = 0; i < poses_a.size(); ++i) {
    EXPECT_EQ(poses_a[i].frame_id, poses_b[i].frame_id);
    EXPECT_EQ(poses_a[i].T_world_camera.matrix(), poses_b[i].T_world_camera.matrix()) << "frame " << i;
  }
  const auto points_a = a.points();
  const auto points_b = b.points();
  ASSERT_EQ(points_a.size(), points_b.size());
  for (std::size_t i = 0; i < points_a.size(); ++i) EXPECT_EQ(points_a[i].position, points_b[i].position);
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Slam, FollowsTheCameraAndMapsWhatItSees) {
  std::vector<std::string> messages;
  Slam slam(scene_calibration(), Settings{},
            [&](LogLevel, const std::string& message) { messages.push_back(message); });
  int tracked = 0;
  for (int i = 0; i < kFrames; ++i) {
    const FrameRecord frame = slam.process(draw_scene(i).view(), 0.1 * i);
    EXPECT_EQ(frame.frame_id, i);
    EXPECT_EQ(frame.timestamp, 0.1 * i);
    EXPECT_EQ(slam.T_world_camera().has_value(), frame.state == TrackingState::kTracked);
    tracked += frame.state == TrackingState::kTracked ? 1 : 0;
  }
  EXPECT_GT(tracked, kFrames / 2);
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find("the map is initialized"), std::string::npos);

  const SE3d last = slam.T_world_camera().value();
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(result.trajectory().back().T_world_camera.matrix(), last.matrix());

  const auto poses = result.trajectory();
  const Eigen::Vector3d way = poses.back().T_world_camera.translation() - poses.front().T_world_camera.translation();
  EXPECT_GT(way.x() / way.norm(), 0.999);
  for (const WorldPoint& point : result.points()) EXPECT_GT(point.position.z(), 0);
  EXPECT_GT(result.points().size(), 300u);
}

TEST(Slam, AnImageThatComesTwiceHasOnePose) {
  constexpr int kTwice = 22;
  Slam slam(scene_calibration(), Settings{});
  for (int i = 0; i < kFrames; ++i) slam.process(draw_scene(i <= kTwice ? i : i - 1).view(), 0.1 * i);
  const SlamResult result = slam.finish();
  ASSERT_EQ(result.frames[kTwice].state, TrackingState::kTracked);
  const FrameRecord& repeated = result.frames[kTwice + 1];
  EXPECT_EQ(repeated.state, TrackingState::kTracked);
  EXPECT_FALSE(repeated.is_keyframe);
  const auto poses = result.trajectory();
  const auto pose = [&](int frame) {
    return std::find_if(poses.begin(), poses.end(), [=](const auto& p) { return p.frame_id == frame; })->T_world_camera;
  };
  EXPECT_EQ(pose(kTwice).matrix(), pose(kTwice + 1).matrix());
  const double step = (pose(kTwice).translation() - pose(kTwice - 1).translation()).norm();
  EXPECT_NEAR((pose(kTwice + 2).translation() - pose(kTwice + 1).translation()).norm(), step, 0.2 * step);
}

TEST(Slam, ResultDoesNotDependOnThreads) {
  Settings settings;
  settings.threads = 1;
  const SlamResult one = run(settings);
  settings.threads = 3;
  const SlamResult three = run(settings);
  ASSERT_GT(one.trajectory().size(), 10u);
  expect_equal(one, three);
}

TEST(Slam, EveryPixelTypeIsTheSameImage) {
  Slam bytes(scene_calibration(), Settings{});
  Slam words(scene_calibration(), Settings{});
  Slam reals(scene_calibration(), Settings{});
  for (int i = 0; i < 20; ++i) {
    const Image<std::uint8_t> image = draw_scene(i);
    bytes.process(image.view(), i);
    words.process(converted<std::uint16_t>(image, 257).view(), i);
    reals.process(converted<float>(image, 1).view(), i);
  }
  const SlamResult result = bytes.finish();
  ASSERT_GT(result.trajectory().size(), 5u);
  expect_equal(result, reals.finish());
  // 257 * v / 257 may differ from v by a rounding step.
  const auto poses = result.trajectory();
  const auto word_poses = words.finish().trajectory();
  ASSERT_EQ(poses.size(), word_poses.size());
  EXPECT_LT((poses.back().T_world_camera.translation() - word_poses.back().T_world_camera.translation()).norm(), 1e-3);
}

TEST(Slam, ImagesMayHaveAStride) {
  Slam plain(scene_calibration(), Settings{});
  Slam strided(scene_calibration(), Settings{});
  for (int i = 0; i < 20; ++i) {
    const Image<std::uint8_t> image = draw_scene(i);
    Image<std::uint8_t> wide(image.width() + 7, image.height(), 255);
    for (int y = 0; y < image.height(); ++y) std::copy_n(image.row(y), image.width(), wide.row(y));
    plain.process(image.view(), i);
    strided.process(ImageView<const std::uint8_t>{wide.data(), image.width(), image.height(), wide.width()}, i);
  }
  expect_equal(plain.finish(), strided.finish());
}

TEST(Slam, ARefusedFrameChangesNothing) {
  Slam slam(scene_calibration(), Settings{});
  const Image<std::uint8_t> small(100, 80);
  for (int i = 0; i < kFrames; ++i) {
    if (i == 15) {
      const std::string error = error_of([&] { slam.process(small.view(), 0.1 * i); });
      EXPECT_NE(error.find("frame 15"), std::string::npos) << error;
      EXPECT_NE(error.find("100 x 80"), std::string::npos) << error;
      EXPECT_NE(error_of([&] { slam.process(draw_scene(i).view(), std::nan("")); }).find("timestamp"),
                std::string::npos);
      EXPECT_NE(error_of([&] { slam.process(ImageView<const float>{}, 0.1 * i); }).find("no pixels"),
                std::string::npos);
    }
    slam.process(draw_scene(i).view(), 0.1 * i);
  }
  expect_equal(slam.finish(), run(Settings{}));
}

/// The size that is claimed is checked before so much is allocated.
TEST(Slam, AWrongSizeIsRefusedBeforeAnythingIsDoneWithTheImage) {
  Slam slam(scene_calibration(), Settings{});
  const std::uint8_t pixel = 0;
  for (const auto& [width, height] : {std::pair{1 << 30, 1 << 30}, {-1, -1}, {0, 0}}) {
    const ImageView<const std::uint8_t> claimed{&pixel, width, height, width};
    const std::string error = error_of([&] { slam.process(claimed, 0); });
    EXPECT_NE(error.find("frame 0: the image has"), std::string::npos) << error;
  }
}

TEST(Slam, OneThatWasMovedFromSaysSo) {
  Slam slam(scene_calibration(), Settings{});
  Slam other = std::move(slam);
  EXPECT_NE(error_of([&] { slam.process(draw_scene(0).view(), 0); }).find("moved"), std::string::npos);
  EXPECT_NE(error_of([&] { slam.T_world_camera(); }).find("moved"), std::string::npos);
  EXPECT_NE(error_of([&] { slam.rectified_camera(); }).find("moved"), std::string::npos);
  EXPECT_NE(error_of([&] { slam.finish(); }).find("moved"), std::string::npos);
  other.process(draw_scene(0).view(), 0);
  slam = std::move(other);
  EXPECT_EQ(slam.finish().frames.size(), 1u);
}

TEST(Slam, AnExposureThatIsNoTimeCountsAsUnknown) {
  Slam slam(scene_calibration(), Settings{});
  for (int i = 0; i < kFrames; ++i) {
    const double exposure = i % 3 == 0 ? 0.0 : i % 3 == 1 ? -1.0 : std::numeric_limits<double>::quiet_NaN();
    slam.process(draw_scene(i).view(), 0.1 * i, exposure);
  }
  expect_equal(slam.finish(), run(Settings{}));
}

TEST(Slam, NothingFollowsTheEnd) {
  Slam slam(scene_calibration(), Settings{});
  EXPECT_TRUE(slam.finish().trajectory().empty());
  EXPECT_NE(error_of([&] { slam.process(draw_scene(0).view(), 0); }).find("finished"), std::string::npos);
  EXPECT_NE(error_of([&] { slam.finish(); }).find("finished"), std::string::npos);
}

TEST(Slam, ASnapshotIsTheRunSoFarAndChangesNothing) {
  Slam slam(scene_calibration(), Settings{});
  for (int i = 0; i < kFrames; ++i) {
    slam.process(draw_scene(i).view(), 0.1 * i);
    const SlamResult so_far = slam.snapshot();
    EXPECT_EQ(so_far.frames.size(), static_cast<std::size_t>(i + 1));
    const auto poses = so_far.trajectory();
    const bool is_tracked = slam.T_world_camera().has_value();
    ASSERT_EQ(!poses.empty() && poses.back().frame_id == i, is_tracked);
    if (!is_tracked) continue;
    EXPECT_TRUE(poses.back().T_world_camera.matrix().isApprox(slam.T_world_camera()->matrix(), 1e-12));
    // Those of the first keyframe are none yet while nothing else has seen them.
    EXPECT_TRUE(i < kFrames - 1 || so_far.points().size() > 100u);
  }
  expect_equal(slam.finish(), run(Settings{}));
  EXPECT_NE(error_of([&] { slam.snapshot(); }).find("finished"), std::string::npos);
}

TEST(Slam, SaysThatTheImagesContradictTheCalibration) {
  Calibration wrong = scene_calibration();
  wrong.camera.model = CameraModelKind::kRadTan;
  wrong.camera.distortion = {0.15, 0, 0, 0};
  wrong.rectification.mode = RectificationMode::kCrop;
  std::string warnings;
  const auto heard = [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) warnings += text + "\n";
  };
  const auto track = [&](const Settings& settings) {
    Slam slam(wrong, settings, heard);
    for (int i = 0; i < 120; ++i) slam.process(draw_scene(i).view(), 0.1 * i);
    return slam.finish();
  };
  const SlamResult result = track(Settings{});
  ASSERT_TRUE(result.better_calibration);
  EXPECT_LT(std::abs(result.better_calibration->camera.distortion[0]), 0.05);
  EXPECT_NE(warnings.find("contradict the calibration"), std::string::npos) << warnings;

  warnings.clear();
  Settings unwatched;
  unwatched.self_calibration.enabled = false;
  EXPECT_FALSE(track(unwatched).better_calibration);
  EXPECT_EQ(warnings.find("contradict"), std::string::npos) << warnings;
  EXPECT_FALSE(run(Settings{}).better_calibration);
}

TEST(Slam, RefusesACalibrationThatIsAGuess) {
  Calibration guess = scene_calibration();
  guess.source = CameraSource::kNone;
  EXPECT_NE(error_of([&] { Slam(guess, Settings{}); }).find("run_sequence()"), std::string::npos);
}

TEST(Slam, RefusesSettingsOutOfRange) {
  Settings settings;
  settings.threads = 0;
  EXPECT_NE(error_of([&] { Slam(scene_calibration(), settings); }).find("setting threads: 0"), std::string::npos);
}

TEST(Slam, SeveralCamerasInOneProcess) {
  Calibration half = scene_calibration();
  half.camera.width /= 2;
  half.camera.height /= 2;
  half.camera.fx = half.camera.fy = half.camera.fx / 2;
  half.camera.cx = (half.camera.width - 1) / 2.0;
  half.camera.cy = (half.camera.height - 1) / 2.0;
  Slam full(scene_calibration(), Settings{});
  Slam small(half, Settings{});
  for (int i = 0; i < kFrames; ++i) {
    const Image<std::uint8_t> image = draw_scene(i);
    Image<float> binned(half.camera.width, half.camera.height);
    for (int y = 0; y < binned.height(); ++y) {
      for (int x = 0; x < binned.width(); ++x) {
        binned(x, y) = 0.25f * static_cast<float>(image(2 * x, 2 * y) + image(2 * x + 1, 2 * y) +
                                                  image(2 * x, 2 * y + 1) + image(2 * x + 1, 2 * y + 1));
      }
    }
    full.process(image.view(), i);
    small.process(binned.view(), i);
  }
  EXPECT_EQ(small.rectified_camera().width, kSceneWidth / 2);
  EXPECT_GT(small.finish().trajectory().size(), 5u);
  expect_equal(full.finish(), run(Settings{}));
}

}  // namespace
}  // namespace ldso
