#include "viewer/recording/recorded_map.h"

#include <gtest/gtest.h>

#include "viewer/map/live_map.h"

namespace ldso {
namespace {

protocol::Keyframe keyframe(std::int64_t id) {
  protocol::Keyframe made =
      protocol::to_keyframe(id, SE3d(SO3d::exp({0, 0.1, 0}), {double(id), 0, 0}),
                            std::vector<MapPoint>(3, {1, 2, 0.5f, 0.1f, 9, true}), {100, 80, 50, 50, 50, 40});
  made.links = {id + 1, id + 2};
  return made;
}

TEST(RecordedMap, HoldsWhatWasRecorded) {
  LiveMap map;
  protocol::Hello hello;
  hello.camera = {100, 80, 50, 51, 49, 39};
  map.start(hello);
  map.add(keyframe(5));
  map.add(keyframe(2));
  const Sim3d S(SO3d::exp({0.3, 0, 0}), {1, 2, 3}, 1.5), correction(SO3d(), {7, 0, 0}, 2.0);
  map.add(LoopEvent{{}, {{2, S}}, correction, 1});
  const RecordedMap read = decode_recorded_map(map.snapshot(), "test");
  EXPECT_EQ(read.camera.fy, 51);
  ASSERT_EQ(read.keyframes.size(), 2u);
  EXPECT_EQ(read.keyframes[0].id, 2);
  EXPECT_EQ(read.keyframes[1].id, 5);
  const protocol::Keyframe wanted = keyframe(5);
  EXPECT_EQ(read.keyframes[1].points, wanted.points);
  EXPECT_EQ(read.keyframes[1].depth_stddev, wanted.depth_stddev);
  EXPECT_EQ(read.keyframes[1].intensity, wanted.intensity);
  EXPECT_EQ(read.keyframes[1].is_corner, wanted.is_corner);
  EXPECT_EQ(read.keyframes[1].links, wanted.links);
  EXPECT_TRUE(read.keyframes[1].T_world_camera.matrix().isApprox(wanted.T_world_camera.matrix(), 1e-12));
  EXPECT_TRUE(read.corrected[0].matrix().isApprox(S.matrix(), 1e-12));
  // One of which loop closing said nothing moves with the newest.
  EXPECT_TRUE(read.corrected[1].matrix().isApprox((correction * Sim3d(wanted.T_world_camera)).matrix(), 1e-12));
}

TEST(RecordedMap, KeepsTheKeyframesOfATrajectory) {
  RecordedMap map;
  for (int i = 0; i < 4; ++i) {
    map.keyframes.push_back(keyframe(i));
    map.keyframes.back().timestamp = 1e9 + 0.1 * i;
    map.corrected.emplace_back(map.keyframes.back().T_world_camera);
  }
  keep_frames_of({{1e9 + 0.1, SE3d()}, {1e9 + 0.15, SE3d()}, {1e9 + 0.3, SE3d()}}, map);
  ASSERT_EQ(map.keyframes.size(), 2u);
  EXPECT_EQ(map.keyframes[0].id, 1);
  EXPECT_EQ(map.corrected[1].translation().x(), 3);
}

TEST(RecordedMap, WhatIsNoRecordingIsRefused) {
  EXPECT_THROW(decode_recorded_map({}, "test"), Error);
  LiveMap map;
  map.start({});
  map.add(keyframe(1));
  Bytes cut = map.snapshot();
  cut.resize(cut.size() - 16);
  EXPECT_THROW(decode_recorded_map(cut, "test"), Error);
}

}  // namespace
}  // namespace ldso
