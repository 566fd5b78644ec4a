#include "output/colmap_export.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

const CameraCalibration kCamera{CameraModelKind::kPinhole, 100, 80, 50, 50, 49.5, 39.5, {}};

/// A keyframe at x that sees a point straight ahead at depth 2 and one to its right.
protocol::Keyframe keyframe(std::int64_t id, double x, std::vector<std::int64_t> links) {
  protocol::Keyframe made;
  made.id = id;
  made.T_world_camera = SE3d(SO3d(), {x, 0, 0});
  made.points = {{0, 0, 2}, {1.9f, 0, 2}};
  made.depth_stddev = {0.01f, 0.2f};
  made.intensity = {10, 20};
  made.is_corner = {0, 1};
  made.links = std::move(links);
  return made;
}

RecordedMap three_keyframes() {
  RecordedMap map;
  map.keyframes = {keyframe(3, 0, {7, 99}), keyframe(7, 1, {}), keyframe(9, 0.5, {})};
  return map;
}

std::vector<Sim3d> poses_of(const RecordedMap& map) {
  std::vector<Sim3d> poses;
  for (const protocol::Keyframe& k : map.keyframes) poses.emplace_back(k.T_world_camera);
  return poses;
}

ColmapModel model_of(const PlacedMap& placed) {
  return predicted_colmap_model(placed, keyframes_of(placed), kCamera, {"3", "7", "9"});
}

TEST(ColmapExport, PointsAreSeenByTheirKeyframeAndThoseOfItsWindow) {
  const RecordedMap map = three_keyframes();
  const ColmapModel model = model_of({map, poses_of(map)});
  ASSERT_EQ(model.points.size(), 6u);
  ASSERT_EQ(model.images.size(), 3u);
  // 3 and 7 shared a window; 9 is alone. 3's points lie at x 0 and 1.9, 7's at 1 and 2.9.
  ASSERT_EQ(model.images[0].observations.size(), 3u);
  EXPECT_EQ(model.images[0].observations[0].point, 0u);
  EXPECT_TRUE(model.images[0].observations[0].pixel.isApprox(Eigen::Vector2d(49.5, 39.5)));
  EXPECT_EQ(model.images[0].observations[1].point, 1u);
  EXPECT_EQ(model.images[0].observations[2].point, 2u);
  EXPECT_TRUE(model.images[0].observations[2].pixel.isApprox(Eigen::Vector2d(74.5, 39.5)));
  EXPECT_EQ(model.images[1].observations.size(), 4u);
  EXPECT_EQ(model.images[2].observations.size(), 2u);
  EXPECT_EQ(model.images[1].name, "7");
  EXPECT_EQ(model.points[1].intensity, 20);
}

TEST(ColmapExport, UnitsOfKeyframesMoveTheirPointsNotTheirPixels) {
  const RecordedMap map = three_keyframes();
  std::vector<Sim3d> poses = poses_of(map);
  poses[2] = Sim3d(SO3d(), {5, 6, 7}, 3.0);
  const ColmapModel model = model_of({map, poses});
  EXPECT_TRUE(model.points[4].position.isApprox(Eigen::Vector3d(5, 6, 13)));
  EXPECT_TRUE(model.images[2].observations[0].pixel.isApprox(Eigen::Vector2d(49.5, 39.5)));
  EXPECT_TRUE(model.images[2].T_world_camera.translation().isApprox(Eigen::Vector3d(5, 6, 7)));
}

TEST(ColmapExport, UncertainPointsCanBeLeftOut) {
  const RecordedMap map = three_keyframes();
  const ColmapModel model = model_of({map, poses_of(map), 0.05});
  EXPECT_EQ(model.points.size(), 3u);
  for (const ColmapPoint& point : model.points) EXPECT_EQ(point.intensity, 10);
}

TEST(ColmapExport, OtherFramesSeeThePointsOfTheKeyframesAroundThem) {
  const RecordedMap map = three_keyframes();
  const std::vector<FramePose> frames = {{2, 0, SE3d()}, {5, 0, SE3d(SO3d(), {0.5, 0, 0})}, {8, 0, SE3d()}};
  const ColmapModel model = predicted_colmap_model({map, poses_of(map)}, frames, kCamera, {"2", "5", "8"});
  EXPECT_TRUE(model.images[0].observations.empty());
  EXPECT_EQ(model.images[1].observations.size(), 3u);  // Those of 3 and of 7, but for one that is outside.
  EXPECT_TRUE(model.images[2].observations.empty());
}

TEST(ColmapExport, ColoursAreThoseOfTheRecording) {
  RecordedMap map = three_keyframes();
  map.keyframes[1].colors = {Rgb{1, 2, 3}, Rgb{4, 5, 6}};
  const ColmapModel model = model_of({map, poses_of(map)});
  EXPECT_FALSE(model.points[0].color);
  EXPECT_EQ(model.points[3].color, (Rgb{4, 5, 6}));
}

}  // namespace
}  // namespace ldso
