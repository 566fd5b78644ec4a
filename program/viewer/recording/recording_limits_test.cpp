#include "viewer/recording/recording_limits.h"

#include <gtest/gtest.h>

#include <map>

#include "viewer/map/live_map.h"

namespace ldso {
namespace {

using protocol::MessageType;

protocol::Keyframe keyframe(std::int64_t id, int points) {
  std::vector<MapPoint> map_points;
  for (int i = 0; i < points; ++i) {
    map_points.push_back({static_cast<float>(i), 2, 0.5f, 0.1f, static_cast<float>(i), i % 2 == 0});
  }
  return protocol::to_keyframe(id, SE3d(SO3d::exp({0.1, 0.2, 0.3}), {1, 2, 3}), map_points, {100, 80, 50, 50, 50, 40});
}

/// 3 keyframes of 10 points, 8 frames of which one comes twice, a warning, 6 positions.
Bytes some_recording() {
  LiveMap map;
  map.start({});
  for (std::int64_t id : {0, 4, 8}) map.add(keyframe(id, 10));
  for (std::int64_t id = 0; id < 8; ++id) {
    FrameEvent event;
    event.frame.frame_id = id;
    map.add(event);
  }
  FrameEvent late;
  late.frame.frame_id = 4;
  late.is_late = true;
  map.add(late);
  map.add(protocol::LogLine{1, true, "lost"});
  std::vector<Eigen::Vector3d> truth;
  for (int i = 0; i < 6; ++i) truth.emplace_back(i, 0, 0);
  map.set_latest(LatestSlot::kTruth, protocol::encode_truth(truth));
  return map.snapshot();
}

std::map<MessageType, std::vector<protocol::Message>> by_type(const Bytes& bytes) {
  std::map<MessageType, std::vector<protocol::Message>> messages;
  for (const protocol::Message& message : protocol::split(bytes, "test")) messages[message.type].push_back(message);
  return messages;
}

TEST(RecordingLimits, WhatIsSmallEnoughStaysButForTheLog) {
  const Bytes recording = some_recording();
  const LimitedRecording limited = limit_recording(recording, {}, "test");
  EXPECT_EQ(limited.points, 30u);
  EXPECT_EQ(limited.points_stride, 1);
  auto before = by_type(recording), after = by_type(limited.bytes);
  EXPECT_TRUE(after[MessageType::kLog].empty());
  EXPECT_EQ(protocol::decode_hello(after[MessageType::kHello].at(0).payload, "").mode, protocol::Mode::kReplay);
  for (const MessageType type : {MessageType::kKeyframe, MessageType::kFrames, MessageType::kTruth}) {
    ASSERT_EQ(after[type].size(), before[type].size());
    for (std::size_t i = 0; i < after[type].size(); ++i) {
      EXPECT_TRUE(std::equal(after[type][i].payload.begin(), after[type][i].payload.end(),
                             before[type][i].payload.begin(), before[type][i].payload.end()));
    }
  }
}

TEST(RecordingLimits, ThinsEvenlyWhatIsTooLarge) {
  const LimitedRecording limited = limit_recording(some_recording(), {12, 4, 3}, "test");
  EXPECT_EQ(limited.points, 30u);
  EXPECT_EQ(limited.points_stride, 3);
  EXPECT_EQ(limited.frames_stride, 3);
  EXPECT_EQ(limited.truth_stride, 2);
  auto messages = by_type(limited.bytes);
  ASSERT_EQ(messages[MessageType::kKeyframe].size(), 3u);
  const protocol::Keyframe whole = keyframe(4, 10);
  const protocol::Keyframe thinned = protocol::decode_keyframe(messages[MessageType::kKeyframe][1].payload, "");
  EXPECT_EQ(thinned.id, 4);
  ASSERT_EQ(thinned.points.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(thinned.points[i], whole.points[3 * i]);
    EXPECT_EQ(thinned.depth_stddev[i], whole.depth_stddev[3 * i]);
    EXPECT_EQ(thinned.intensity[i], whole.intensity[3 * i]);
    EXPECT_EQ(thinned.is_corner[i], whole.is_corner[3 * i]);
  }
  ByteReader frames(messages[MessageType::kFrames].at(0).payload, "");
  EXPECT_EQ(frames.get<std::uint32_t>(), 3u);  // 0, 3, 6; the late record of 4 goes with its frame.
  ByteReader truth(messages[MessageType::kTruth].at(0).payload, "");
  EXPECT_EQ(truth.get<std::uint32_t>(), 3u);
  truth.get_bytes(4 + 24);
  EXPECT_EQ(truth.get<double>(), 2.0);
}

TEST(RecordingLimits, DamageIsNamed) {
  Bytes recording = some_recording();
  recording.resize(recording.size() / 2);
  EXPECT_THROW(limit_recording(recording, {}, "test"), Error);
}

}  // namespace
}  // namespace ldso
