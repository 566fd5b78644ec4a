#include "viewer/map/protocol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace ldso::protocol {
namespace {

Message only_message(const Bytes& bytes) {
  const std::vector<Message> messages = split(bytes, "test");
  EXPECT_EQ(messages.size(), 1u);
  return messages.front();
}

SE3d some_pose() { return SE3d(SO3d::exp({0.1, -0.2, 0.3}), {1, 2, 3}); }

/// Of a reader, 7 numbers: translation, then x y z w.
template <class T>
SE3d read_pose(ByteReader& in) {
  double v[7];
  for (double& x : v) x = static_cast<double>(in.get<T>());
  return SE3d(SO3d(Eigen::Quaterniond(v[6], v[3], v[4], v[5])), {v[0], v[1], v[2]});
}

TEST(Protocol, HelloComesBack) {
  Hello hello;
  hello.run_id = 0x123456789abcdef0;
  hello.epoch = 3;
  hello.mode = Mode::kReplay;
  hello.has_control = true;
  hello.camera = {640, 480, 500.5, 501.5, 319.5, 239.5};
  hello.name = "a/sequence \xc3\xa4";
  const Bytes bytes = encode(hello);
  EXPECT_EQ(bytes.size() % 8, 0u);
  const Message message = only_message(bytes);
  EXPECT_EQ(message.type, MessageType::kHello);
  const Hello back = decode_hello(message.payload, "test");
  EXPECT_EQ(back.run_id, hello.run_id);
  EXPECT_EQ(back.epoch, 3u);
  EXPECT_EQ(back.mode, Mode::kReplay);
  EXPECT_TRUE(back.has_control);
  EXPECT_EQ(back.camera.width, 640);
  EXPECT_EQ(back.camera.cy, 239.5);
  EXPECT_EQ(back.name, hello.name);
}

TEST(Protocol, AnotherVersionIsRefusedByName) {
  Bytes bytes = encode(Hello{});
  bytes[12] = 77;  // after the header and the magic
  const Message message = only_message(bytes);
  try {
    decode_hello(message.payload, "old.ldso");
    FAIL() << "it was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("old.ldso"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("version 77"), std::string::npos) << error.what();
  }
}

TEST(Protocol, BytesAreLittleEndian) {
  Hello hello;
  hello.run_id = 0x0102030405060708;
  const Bytes bytes = encode(hello);
  EXPECT_EQ(bytes[0], bytes.size());  // size
  EXPECT_EQ(bytes[1], 0);
  EXPECT_EQ(bytes[4], 1);  // type
  EXPECT_EQ(std::string(bytes.begin() + 8, bytes.begin() + 12), "LDSO");
  EXPECT_EQ(bytes[16], 0x08);
  EXPECT_EQ(bytes[23], 0x01);
}

TEST(Protocol, DamagedStreamsAreErrors) {
  const Bytes good = encode(Hello{});
  const Bytes cut(good.begin(), good.end() - 1);
  EXPECT_THROW(split(cut, "test"), Error);
  Bytes small = good;
  small[0] = 4;  // less than a header
  EXPECT_THROW(split(small, "test"), Error);
  Bytes long_name = good;
  long_name[8 + 64] = 0xff;  // a name longer than the message
  EXPECT_THROW(decode_hello(only_message(long_name).payload, "test"), Error);
  EXPECT_TRUE(split({}, "test").empty());
}

TEST(Protocol, KeyframePointsAreInTheCamera) {
  const PinholeIntrinsics camera{100, 80, 50, 60, 49.5, 39.5};
  std::vector<MapPoint> points(4);
  points[0] = {49.5f, 39.5f, 0.5f, 0.01f, 100.4f, true};
  points[1] = {99.5f, 39.5f, 0.25f, 0.01f, 300.0f, false};
  points[2].idepth = 0;                                         // infinitely far
  points[3].idepth = -std::numeric_limits<float>::quiet_NaN();  // nothing
  const Keyframe keyframe = to_keyframe(7, some_pose(), points, camera);
  ASSERT_EQ(keyframe.points.size(), 2u);
  EXPECT_TRUE(keyframe.points[0].isApprox(Eigen::Vector3f(0, 0, 2)));
  EXPECT_TRUE(keyframe.points[1].isApprox(Eigen::Vector3f(4, 0, 4)));
  EXPECT_FLOAT_EQ(keyframe.depth_stddev[0], 0.02f);
  EXPECT_EQ(keyframe.intensity[0], 100);
  EXPECT_EQ(keyframe.intensity[1], 255);
  EXPECT_EQ(keyframe.is_corner[0], 1);
}

TEST(Protocol, KeyframeMessage) {
  Keyframe keyframe =
      to_keyframe(7, some_pose(), std::vector<MapPoint>{{1, 2, 0.5f, 0.1f, 9, true}}, {100, 80, 50, 60, 49.5, 39.5});
  keyframe.timestamp = 1.5;
  keyframe.links = {3, 5};
  const Bytes bytes = encode(keyframe);
  const Message message = only_message(bytes);
  EXPECT_EQ(message.type, MessageType::kKeyframe);
  ByteReader in(message.payload, "test");
  EXPECT_EQ(in.get<std::int64_t>(), 7);
  EXPECT_EQ(in.get<double>(), 1.5);
  EXPECT_TRUE(read_pose<double>(in).matrix().isApprox(some_pose().matrix(), 1e-12));
  EXPECT_EQ(in.get<std::uint32_t>(), 1u);
  EXPECT_EQ(in.get<std::uint32_t>(), 2u);
  EXPECT_EQ(in.get<std::int64_t>(), 3);
  EXPECT_EQ(in.get<std::int64_t>(), 5);
  EXPECT_EQ((message.payload.size() - in.left()) % 8, 0u);  // arrays can be laid over it
  EXPECT_FLOAT_EQ(in.get<float>(), keyframe.points[0].x());
}

TEST(Protocol, KeyframesOfTheFirstVersionsHaveNeitherSegmentNorColours) {
  Keyframe keyframe =
      to_keyframe(7, some_pose(), std::vector<MapPoint>(3, {1, 2, 0.5f, 0.1f, 9, true}), {100, 80, 50, 60, 49.5, 39.5});
  const Bytes plain = encode(keyframe);
  const std::span<const std::uint8_t> payload = only_message(plain).payload;
  EXPECT_EQ(decode_keyframe(payload.first(payload.size() - 8), "test").points.size(), 3u);
  keyframe.segment = 2;
  keyframe.colors = {Rgb{1, 2, 3}, Rgb{4, 5, 6}, Rgb{7, 8, 9}};
  const Bytes bytes = encode(keyframe);
  const Keyframe read = decode_keyframe(only_message(bytes).payload, "test");
  EXPECT_EQ(read.segment, 2);
  EXPECT_EQ(read.colors, keyframe.colors);
  const Bytes cut(bytes.begin(), bytes.end() - 8);
  EXPECT_THROW(decode_keyframe(std::span(cut).subspan(8), "test"), Error);
}

TEST(Protocol, FrameMessage) {
  FrameEvent event;
  event.frame.frame_id = 11;
  event.frame.timestamp = 2.25;
  event.frame.keyframe_id = 7;
  event.frame.state = TrackingState::kTracked;
  event.frame.T_keyframe_frame = some_pose();
  event.frame.brightness_a = 0.25f;
  event.T_world_camera = some_pose().inverse();
  event.points = 1234;
  const FrameEvent events[] = {event, FrameEvent{}};
  const Bytes bytes = encode(std::span<const FrameEvent>(events));
  EXPECT_EQ(bytes.size(), 8u + 8u + 2 * 112u);
  ByteReader in(only_message(bytes).payload, "test");
  EXPECT_EQ(in.get<std::uint64_t>(), 2u);
  EXPECT_EQ(in.get<std::int64_t>(), 11);
  EXPECT_EQ(in.get<double>(), 2.25);
  EXPECT_EQ(in.get<std::int64_t>(), 7);
  EXPECT_TRUE(read_pose<float>(in).matrix().isApprox(some_pose().matrix(), 1e-6));
  EXPECT_TRUE(read_pose<float>(in).matrix().isApprox(some_pose().inverse().matrix(), 1e-6));
  in.get_bytes(12);
  EXPECT_EQ(in.get<float>(), 0.0f);  // b
  in.get<float>();
  EXPECT_EQ(in.get<std::uint32_t>(), 1234u);
  EXPECT_EQ(in.get<std::uint8_t>(), static_cast<std::uint8_t>(TrackingState::kTracked));
  in.get_bytes(2);
  EXPECT_EQ(in.get<std::uint8_t>(), 1u);  // has a pose
}

TEST(Protocol, EveryMessageIsWholeAndAligned) {
  LiveView view;
  view.camera = {100, 80, 50, 60, 49.5, 39.5};
  view.window.resize(2);
  view.window[0].points.resize(3, {1, 2, 0.5f, 0.1f, 9, true});
  const ViewPixel pixel{1, 2, 3, true, true};
  const std::vector<std::uint8_t> jpeg(13, 5);
  Bytes stream;
  const LogLine lines[] = {{1, true, "odd length"}, {2, false, ""}};
  const Loop loop{5, 1, 9, 80, 0.5f};
  for (const Bytes& bytes :
       {encode(Poses{1, {}, {{3, Sim3d()}}}), encode(std::span<const Loop>(&loop, 1)),
        encode(std::span<const LogLine>(lines)), encode_truth(std::vector<Eigen::Vector3d>(3)), encode(Alignment{}),
        encode(Status{}), encode_window(view, Sim3d()), encode_image({1, 100, 80, jpeg}, std::span(&pixel, 1))}) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
  }
  const std::vector<Message> messages = split(stream, "test");
  ASSERT_EQ(messages.size(), 8u);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(messages[i].type), i < 1 ? 3 : i + 4);
  }
}

TEST(Protocol, CommandsOfOneByte) {
  const std::uint8_t step[] = {3}, unknown[] = {9}, two[] = {1, 1};
  EXPECT_EQ(decode_command(step), Command::kStep);
  EXPECT_FALSE(decode_command(unknown));
  EXPECT_FALSE(decode_command(two));
  EXPECT_FALSE(decode_command({}));
}

TEST(Protocol, NumbersThatAreNoneAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto is_refused = [](const Bytes& bytes, std::size_t offset, auto value) {
    Bytes changed = bytes;
    const auto raw = to_bytes(value);
    std::copy(raw.begin(), raw.end(), changed.begin() + static_cast<std::ptrdiff_t>(offset));
    const Message message = only_message(changed);
    try {
      if (message.type == MessageType::kHello) decode_hello(message.payload, "test");
      if (message.type == MessageType::kKeyframe) decode_keyframe(message.payload, "test");
      if (message.type == MessageType::kPoses) decode_poses(message.payload, "test");
      return false;
    } catch (const Error&) {
      return true;
    }
  };
  Keyframe keyframe;
  keyframe.points = {{1, 2, 3}};
  keyframe.depth_stddev = {0.1F};
  keyframe.intensity = keyframe.is_corner = {1};
  const Bytes bytes = encode(keyframe);
  EXPECT_FALSE(is_refused(bytes, 24, 5.0));
  EXPECT_TRUE(is_refused(bytes, 24, kNan));
  EXPECT_TRUE(is_refused(bytes, 24, 1e200));
  EXPECT_TRUE(is_refused(bytes, 72, 0.0)) << "a quaternion of length 0";
  EXPECT_TRUE(is_refused(bytes, 88, std::numeric_limits<float>::infinity())) << "a point";
  EXPECT_TRUE(is_refused(bytes, 80, std::uint32_t{0xffffffff})) << "the number of points";
  const Bytes poses = encode(Poses{});
  EXPECT_FALSE(is_refused(poses, 72, 2.0));
  for (const double scale : {0.0, -1.0, kNan}) EXPECT_TRUE(is_refused(poses, 72, scale)) << scale;
  EXPECT_TRUE(is_refused(poses, 80, std::uint32_t{0xffffffff})) << "the number of poses";
  EXPECT_TRUE(is_refused(encode(Hello()), 40, kNan)) << "a focal length";
}

}  // namespace
}  // namespace ldso::protocol
