#include "viewer/map/live_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

using protocol::MessageType;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

std::vector<MessageType> types(const std::vector<SharedBytes>& messages) {
  std::vector<MessageType> result;
  for (const SharedBytes& bytes : messages) {
    for (const protocol::Message& message : protocol::split(*bytes, "test")) result.push_back(message.type);
  }
  return result;
}

protocol::Keyframe keyframe(std::int64_t id, int points = 2) {
  std::vector<MapPoint> map_points(static_cast<std::size_t>(points), {1, 2, 0.5f, 0.1f, 9, false});
  return protocol::to_keyframe(id, SE3d(SO3d(), {static_cast<double>(id), 0, 0}), map_points,
                               {100, 80, 50, 50, 50, 40});
}

FrameEvent frame(std::int64_t id, std::int64_t keyframe_id, double x = 0) {
  FrameEvent event;
  event.frame.frame_id = id;
  event.frame.timestamp = 0.1 * static_cast<double>(id);
  event.frame.state = TrackingState::kTracked;
  event.frame.keyframe_id = keyframe_id;
  event.frame.T_keyframe_frame = SE3d(SO3d(), {x, 0, 0});
  event.T_world_camera = SE3d(SO3d(), {static_cast<double>(keyframe_id) + x, 0, 0});
  return event;
}

TEST(LiveMap, GivesNothingBeforeItStarts) {
  const LiveMap map;
  MapCursor cursor;
  EXPECT_TRUE(map.next(cursor, kAll).empty());
}

TEST(LiveMap, LateJoinerGetsTheWholeMapAndOthersTheRestOnly) {
  LiveMap map;
  map.start({});
  MapCursor early;
  EXPECT_EQ(types(map.next(early, kAll)), std::vector{MessageType::kHello});
  map.add(keyframe(1));
  map.add(frame(1, 1));
  EXPECT_EQ(types(map.next(early, kAll)), (std::vector{MessageType::kKeyframe, MessageType::kFrames}));
  map.add(keyframe(2));
  EXPECT_EQ(types(map.next(early, kAll)), std::vector{MessageType::kKeyframe});
  EXPECT_TRUE(map.next(early, kAll).empty());
  MapCursor late;
  EXPECT_EQ(types(map.next(late, kAll)),
            (std::vector{MessageType::kHello, MessageType::kKeyframe, MessageType::kKeyframe, MessageType::kFrames}));
}

TEST(LiveMap, ComesInPartsThatLoseNothing) {
  LiveMap map;
  map.start({});
  for (int id = 0; id < 100; ++id) map.add(keyframe(id, 50));
  MapCursor cursor;
  std::set<const Bytes*> seen;
  int parts = 0;
  while (true) {
    const auto part = map.next(cursor, 5000);
    if (part.empty()) break;
    ++parts;
    std::size_t bytes = 0;
    for (const SharedBytes& message : part) {
      bytes += message->size();
      seen.insert(message.get());
    }
    EXPECT_LT(bytes, 8000u);
  }
  EXPECT_GT(parts, 10);
  EXPECT_EQ(seen.size(), 101u);
}

TEST(LiveMap, TheTrajectoryIsThatOfTheLargestPart) {
  LiveMap map;
  map.start({});
  for (int id = 0; id < 5; ++id) {
    protocol::Keyframe added = keyframe(id);
    added.segment = id < 3 ? 0 : 1;
    map.add(added);
    FrameEvent event;
    event.frame.frame_id = event.frame.keyframe_id = id;
    event.frame.state = TrackingState::kTracked;
    event.T_world_camera = SE3d();
    map.add(event);
  }
  EXPECT_EQ(map.trajectory().size(), 3u);
  LoopEvent loop;
  loop.accepted.emplace_back();
  loop.accepted.back().keyframe_id = 4;
  loop.accepted.back().candidate_id = 1;
  map.add(loop);
  EXPECT_EQ(map.trajectory().size(), 5u);
}

TEST(LiveMap, OfViewsOnlyTheNewestIsSent) {
  LiveMap map;
  map.start({});
  MapCursor cursor;
  map.next(cursor, kAll);
  for (int i = 0; i < 5; ++i) map.set_latest(LatestSlot::kImage, encode(protocol::Status{}));
  EXPECT_EQ(map.next(cursor, kAll).size(), 1u);
  EXPECT_TRUE(map.next(cursor, kAll).empty());
}

TEST(LiveMap, ChangedPosesAloneAreSentAgain) {
  LiveMap map;
  map.start({});
  for (int id = 0; id < 10; ++id) map.add(keyframe(id));
  LoopEvent event;
  for (int id = 0; id < 10; ++id) event.poses.push_back({id, Sim3d()});
  map.add(event);
  MapCursor cursor;
  map.next(cursor, kAll);
  event.poses = {{4, Sim3d(SO3d(), {1, 1, 1}, 2)}};
  event.correction = Sim3d(SO3d(), {5, 0, 0}, 1);
  map.add(event);
  const auto messages = map.next(cursor, kAll);
  ASSERT_EQ(types(messages), std::vector{MessageType::kPoses});
  ByteReader in(protocol::split(*messages[0], "test")[0].payload, "test");
  in.get<std::int64_t>();
  EXPECT_EQ(in.get<double>(), 5.0);
  in.get_bytes(7 * 8);
  EXPECT_EQ(in.get<std::uint64_t>(), 1u);
  EXPECT_EQ(in.get<std::int64_t>(), 4);
}

TEST(LiveMap, StartingAnewVoidsEverythingButTruthAndStatus) {
  LiveMap map;
  map.set_latest(LatestSlot::kTruth, protocol::encode_truth({}));
  map.start({});
  map.add(keyframe(1));
  map.set_latest(LatestSlot::kImage, encode(protocol::Status{}));
  MapCursor cursor;
  map.next(cursor, kAll);
  map.start({});
  map.add(keyframe(8));
  EXPECT_EQ(types(map.next(cursor, kAll)),
            (std::vector{MessageType::kHello, MessageType::kKeyframe, MessageType::kTruth}));
}

TEST(LiveMap, TrajectoryFollowsTheCorrectedKeyframes) {
  LiveMap map;
  map.start({});
  map.add(keyframe(1));
  map.add(frame(1, 1));
  map.add(frame(2, 1, 0.5));
  map.add(frame(3, 9));  // Its keyframe is in the window still.
  FrameEvent lost;
  lost.frame.frame_id = 4;
  map.add(lost);
  map.add(frame(2, 1, 0.25));  // Replaces the first one.
  LoopEvent event;
  event.correction = Sim3d(SO3d(), {0, 10, 0}, 2);
  event.poses = {{1, Sim3d(SO3d(), {0, 0, 7}, 2)}};
  map.add(event);
  const Trajectory trajectory = map.trajectory();
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_TRUE(trajectory[0].T_world_camera.translation().isApprox(Eigen::Vector3d(0, 0, 7)));
  EXPECT_TRUE(trajectory[1].T_world_camera.translation().isApprox(Eigen::Vector3d(0.5, 0, 7)));
  EXPECT_TRUE(trajectory[2].T_world_camera.translation().isApprox(Eigen::Vector3d(18, 10, 0)));
}

TEST(LiveMap, RecordingIsWhatALateJoinerGets) {
  LiveMap map;
  protocol::Hello hello;
  hello.name = "somewhere";
  hello.has_control = true;
  map.start(hello);
  map.add(keyframe(1));
  map.add(frame(1, 1));
  LoopEvent event;
  event.poses = {{1, Sim3d()}};
  event.accepted.resize(1);
  map.add(event);
  map.add(protocol::LogLine{1, true, "careful"});
  map.set_latest(LatestSlot::kStatus, encode(protocol::Status{}));
  map.set_latest(LatestSlot::kTruth, protocol::encode_truth({}));
  const auto path = std::filesystem::path(testing::TempDir()) / "live_map_test.ldso";
  write_recording(path, map.snapshot());

  LiveMap replay;
  read_recording(path, replay);
  EXPECT_EQ(replay.hello().name, "somewhere");
  EXPECT_EQ(replay.hello().mode, protocol::Mode::kReplay);
  EXPECT_FALSE(replay.hello().has_control);
  MapCursor cursor;
  EXPECT_EQ(types(replay.next(cursor, kAll)),
            (std::vector{MessageType::kHello, MessageType::kKeyframe, MessageType::kLoops, MessageType::kLog,
                         MessageType::kFrames, MessageType::kPoses, MessageType::kTruth}));
  std::filesystem::remove(path);
}

TEST(LiveMap, DamagedRecordingsAreErrorsThatNameTheFile) {
  const auto path = std::filesystem::path(testing::TempDir()) / "damaged.ldso";
  LiveMap map;
  map.start({});
  Bytes bytes = map.snapshot();
  bytes.pop_back();
  write_recording(path, bytes);
  LiveMap replay;
  try {
    read_recording(path, replay);
    FAIL() << "it was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("damaged.ldso"), std::string::npos) << error.what();
  }
  write_recording(path, {});
  EXPECT_THROW(read_recording(path, replay), Error);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace ldso
