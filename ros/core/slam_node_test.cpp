#include "core/slam_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <unistd.h>

#include "ldso/error.h"
#include "ldso/io/trajectory_file.h"
#include "ldso/slam.h"
#include "slam/test_scene.h"

namespace ldso::ros {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFrameNs = 100'000'000;
constexpr std::int64_t kBeginNs = 1'000'000'000'000;
constexpr int kFrames = 40;

/// Keeps what a node publishes.
class Recorder final : public NodeOutput {
 public:
  void pose(const NodePose& pose) override { poses.push_back(pose); }
  void map(std::int64_t, const std::vector<NodePose>& new_path, const std::vector<NodePoint>& points) override {
    ++maps;
    path = new_path;
    cloud = points;
  }
  void log(LogLevel level, const std::string& text) override {
    const std::lock_guard lock(mutex);
    if (level == LogLevel::kWarning) warnings += text + "\n";
  }

  std::vector<NodePose> poses, path;
  std::vector<NodePoint> cloud;
  int maps = 0;
  std::mutex mutex;  ///< Of warnings.
  std::string warnings;
};

NodeImage scene_image(int frame, std::int64_t stamp_ns) {
  const auto pixels = std::make_shared<const Image<std::uint8_t>>(draw_scene(frame));
  NodeImage image;
  image.stamp_ns = stamp_ns;
  image.frame = "camera_optical";
  image.image.width = kSceneWidth;
  image.image.height = kSceneHeight;
  image.image.encoding = "mono8";
  image.image.step = kSceneWidth;
  image.image.data = pixels->data();
  image.image.size = pixels->size();
  image.owner = pixels;
  return image;
}

RosCameraInfo scene_info() {
  const CameraCalibration camera = scene_calibration().camera;
  RosCameraInfo info;
  info.width = kSceneWidth;
  info.height = kSceneHeight;
  info.model = "plumb_bob";
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  return info;
}

NodeOptions all_images() {
  NodeOptions options;
  options.queue_size = 0;
  options.rep103 = false;
  return options;
}

void play(SlamNode& node, int frames = kFrames, std::int64_t begin_ns = kBeginNs) {
  for (int i = 0; i < frames; ++i) node.on_image(scene_image(i, begin_ns + i * kFrameNs));
}

std::string figure(const SlamNode& node, const std::string& name) {
  for (const auto& [own, value] : node.status().figures) {
    if (own == name) return value;
  }
  return "";
}

TEST(SlamNode, PublishesWhatSlamFinds) {
  Recorder recorder;
  NodeOptions options = all_images();
  options.map_period_s = 1;
  SlamNode node(options, recorder);
  play(node);
  EXPECT_EQ(node.status().message, "waiting for camera_info");
  node.on_camera_info(scene_info());
  node.finish();

  Slam slam(scene_calibration(), Settings{});
  std::vector<SE3d> poses;
  for (int i = 0; i < kFrames; ++i) {
    slam.process(draw_scene(i).view(), 1e-9 * (kBeginNs + i * kFrameNs));
    if (const auto pose = slam.T_world_camera()) poses.push_back(*pose);
  }
  const std::vector<TimedPose> path = slam.snapshot().trajectory();
  ASSERT_GT(poses.size(), 10U);
  ASSERT_EQ(recorder.poses.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(recorder.poses[i].position[0], poses[i].translation().x()) << i;
  EXPECT_EQ(recorder.poses.back().stamp_ns, kBeginNs + (kFrames - 1) * kFrameNs);
  EXPECT_EQ(recorder.poses.back().camera_frame, "camera_optical");
  ASSERT_EQ(recorder.path.size(), path.size());
  EXPECT_EQ(recorder.path[3].position[0], path[3].T_world_camera.translation().x());
  EXPECT_EQ(recorder.maps, 4);  // Three times a second has passed, and at the end.
  EXPECT_GT(recorder.cloud.size(), 100U);
  EXPECT_EQ(node.status().level, NodeLevel::kOk);
  EXPECT_EQ(figure(node, "processed"), std::to_string(kFrames));
  EXPECT_EQ(recorder.warnings, "");
}

TEST(SlamNode, WritesItsResults) {
  const fs::path folder = fs::temp_directory_path() / ("ldso_ros_test_" + std::to_string(::getpid()));
  Recorder recorder;
  NodeOptions options = all_images();
  options.results = folder / "out";
  SlamNode node(options, recorder);
  node.on_camera_info(scene_info());
  play(node, 20);
  play(node, 20);  // Again from the beginning.
  node.finish();
  EXPECT_EQ(read_tum_trajectory(folder / "out/trajectory.txt").size(), 20U);
  EXPECT_EQ(read_tum_trajectory(folder / "out_2/trajectory.txt").size(), 20U);
  EXPECT_TRUE(fs::exists(folder / "out/run.json"));
  EXPECT_NE(recorder.warnings.find("new run"), std::string::npos);
  fs::remove_all(folder);
}

TEST(SlamNode, RefusesImagesThatAreNoneAndGoesOn) {
  Recorder recorder;
  SlamNode node(all_images(), recorder);
  node.on_camera_info(scene_info());
  play(node, 20);
  NodeImage depth = scene_image(20, kBeginNs + 20 * kFrameNs);
  depth.image.encoding = "32FC1";
  node.on_image(depth);
  NodeImage small = scene_image(20, kBeginNs + 20 * kFrameNs);
  small.image.height = 20;
  node.on_image(small);
  node.on_image(scene_image(20, kBeginNs + 13 * kFrameNs));  // Of the past.
  node.on_image(scene_image(20, kBeginNs + 20 * kFrameNs));
  node.finish();
  EXPECT_EQ(figure(node, "refused"), "3");
  EXPECT_EQ(figure(node, "processed"), "21");
  EXPECT_NE(recorder.warnings.find("32FC1"), std::string::npos);
  EXPECT_NE(recorder.warnings.find("not later"), std::string::npos);
  EXPECT_EQ(recorder.poses.back().stamp_ns, kBeginNs + 20 * kFrameNs);
}

TEST(SlamNode, DropsImagesThatCannotWait) {
  Recorder recorder;
  NodeOptions options;
  options.queue_size = 3;
  SlamNode node(options, recorder);
  play(node, 10);  // Before there is a calibration: three wait.
  EXPECT_EQ(figure(node, "dropped"), "7");
  node.finish();
  EXPECT_TRUE(recorder.poses.empty());
}

TEST(SlamNode, SaysOnceThatTheCameraIsNotCalibrated) {
  Recorder recorder;
  SlamNode node(all_images(), recorder);
  RosCameraInfo info = scene_info();
  info.K = {};
  node.on_camera_info(info);
  node.on_camera_info(info);
  EXPECT_EQ(recorder.warnings.find("not calibrated"), recorder.warnings.rfind("not calibrated"));
  EXPECT_NE(recorder.warnings.find("not calibrated"), std::string::npos);
  node.on_camera_info(scene_info());
  EXPECT_EQ(node.status().message, "waiting for images");
}

TEST(SlamNode, OptionsThatMakeNoSenseAreRefused) {
  Recorder recorder;
  NodeOptions options;
  options.calibration = "/no/such/camera.txt";
  EXPECT_THROW(SlamNode(options, recorder), Error);
  options = {};
  options.settings = {"selection.candidates=-5"};
  EXPECT_THROW(SlamNode(options, recorder), Error);
}

TEST(SlamNode, KnowsWhereItsCameraInfoIs) {
  NodeOptions options;
  options.image_topic = "/front/image_raw";
  EXPECT_EQ(info_topic(options), "/front/camera_info");
}

}  // namespace
}  // namespace ldso::ros
