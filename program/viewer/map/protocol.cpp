#include "viewer/map/protocol.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "geometry/rolling_shutter.h"

namespace ldso::protocol {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are, little-endian");

constexpr std::size_t kHeaderBytes = 8;
constexpr char kMagic[] = "LDSO";

/// A message under construction: its header first, whose size is known at the end.
class MessageWriter : public ByteWriter {
 public:
  explicit MessageWriter(MessageType type, std::size_t expected = 64) {
    reserve(kHeaderBytes + expected);
    put<std::uint32_t>(0);
    put(static_cast<std::uint16_t>(type));
    put<std::uint16_t>(0);
  }

  Bytes finish() {
    align(8);  // So that typed arrays can be laid over any message of a stream.
    patch(0, static_cast<std::uint32_t>(size()));
    return take();
  }

  template <class T, int N>
  void put_vector(const Eigen::Matrix<T, N, 1>& v) {
    for (int i = 0; i < N; ++i) put(v[i]);
  }
  template <class T>
  void put_pose(const SE3d& pose) {
    put_vector(Eigen::Matrix<T, 3, 1>(pose.translation().cast<T>()));
    put_vector(Eigen::Matrix<T, 4, 1>(pose.rotation().quaternion().coeffs().cast<T>()));  // x y z w
  }
  void put_similarity(const Sim3d& S) {
    put_pose<double>(SE3d(S.rotation(), S.translation()));
    put(S.scale());
  }
  void put_count(std::size_t count) { put(static_cast<std::uint32_t>(count)); }
  /// As they lie in memory.
  template <class T>
  void put_all(const std::vector<T>& values) {
    put_bytes({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)});
  }
  /// The arrays of a keyframe's points.
  void put_points(const Keyframe& keyframe) {
    static_assert(sizeof(Eigen::Vector3f) == 12);
    put_all(keyframe.points);
    put_all(keyframe.depth_stddev);
    put_all(keyframe.intensity);
    put_all(keyframe.is_corner);
    align(8);
  }
};

void put_frame(MessageWriter& out, const FrameEvent& event) {
  const FrameRecord& frame = event.frame;
  out.put(frame.frame_id);
  out.put(frame.timestamp);
  out.put(frame.keyframe_id);
  out.put_pose<float>(frame.T_keyframe_frame);
  out.put_pose<float>(event.T_world_camera.value_or(SE3d()));
  out.put(static_cast<float>(event.frame_ms));
  out.put(frame.residual_rmse);
  out.put(frame.brightness_a);
  out.put(frame.brightness_b);
  out.put(static_cast<float>(event.exposure_ms));
  out.put(static_cast<std::uint32_t>(event.points));
  out.put(static_cast<std::uint8_t>(frame.state));
  out.put(static_cast<std::uint8_t>(frame.is_keyframe));
  out.put(static_cast<std::uint8_t>(event.is_late));
  out.put(static_cast<std::uint8_t>(event.T_world_camera.has_value()));
  out.align(8);
}

/// Coordinates beyond this are damage; below it products of a few poses stay finite.
constexpr double kFarthest = 1e60;

bool is_sane(double value) { return std::abs(value) < kFarthest; }

SE3d get_pose(ByteReader& in) {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  for (int i = 0; i < 3; ++i) t[i] = in.get<double>();
  for (int i = 0; i < 4; ++i) q.coeffs()[i] = in.get<double>();
  const bool is_pose = is_sane(t.x()) && is_sane(t.y()) && is_sane(t.z()) && std::abs(q.norm() - 1) < 1e-3;
  if (!is_pose) in.fail("a pose in it is none");
  return {SO3d(q), t};
}

Sim3d get_similarity(ByteReader& in) {
  const SE3d T = get_pose(in);
  const auto scale = in.get<double>();
  if (!(scale > 1 / kFarthest && is_sane(scale))) in.fail("a scale in it is none");
  return {T.rotation(), T.translation(), scale};
}

/// As they lie in memory.
template <class T>
void get_all(ByteReader& in, std::size_t count, std::vector<T>& values) {
  const std::span<const std::uint8_t> bytes = in.get_bytes(count * sizeof(T));
  values.resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
}

}  // namespace

Bytes encode(const Hello& hello) {
  MessageWriter out(MessageType::kHello);
  out.put_text({kMagic, 4});
  out.put(kVersion);
  out.put(hello.run_id);
  out.put(hello.epoch);
  out.put(static_cast<std::uint8_t>(hello.mode));
  out.put(static_cast<std::uint8_t>(hello.has_control));
  out.put<std::uint16_t>(0);
  out.put(static_cast<std::uint32_t>(hello.camera.width));
  out.put(static_cast<std::uint32_t>(hello.camera.height));
  for (const double x : {hello.camera.fx, hello.camera.fy, hello.camera.cx, hello.camera.cy}) out.put(x);
  out.put_count(hello.name.size());
  out.put_text(hello.name);
  out.align(8);
  out.put(hello.metres_per_unit);
  return out.finish();
}

Bytes encode(const Keyframe& keyframe) {
  MessageWriter out(MessageType::kKeyframe, 96 + 8 * keyframe.links.size() + 18 * keyframe.points.size());
  out.put(keyframe.id);
  out.put(keyframe.timestamp);
  out.put_pose<double>(keyframe.T_world_camera);
  out.put_count(keyframe.points.size());
  out.put_count(keyframe.links.size());
  out.put_all(keyframe.links);
  out.put_points(keyframe);
  out.put(static_cast<std::uint32_t>(keyframe.segment));
  out.put(static_cast<std::uint32_t>(keyframe.colors.empty() ? 0 : 1));
  out.put_all(keyframe.colors);
  return out.finish();
}

Bytes encode(const Poses& poses) {
  MessageWriter out(MessageType::kPoses, 96 + 72 * poses.poses.size());
  out.put(poses.at_frame);
  out.put_similarity(poses.correction);
  out.put_count(poses.poses.size());
  out.align(8);
  for (const KeyframePose& pose : poses.poses) {
    out.put(pose.keyframe_id);
    out.put_similarity(pose.S_world_keyframe);
  }
  return out.finish();
}

Bytes encode(std::span<const FrameEvent> frames) {
  MessageWriter out(MessageType::kFrames, 16 + 112 * frames.size());
  out.put_count(frames.size());
  out.align(8);
  for (const FrameEvent& frame : frames) put_frame(out, frame);
  return out.finish();
}

Bytes encode(std::span<const Loop> loops) {
  MessageWriter out(MessageType::kLoops, 16 + 32 * loops.size());
  out.put_count(loops.size());
  out.align(8);
  for (const Loop& loop : loops) {
    out.put(loop.keyframe_id);
    out.put(loop.candidate_id);
    out.put(loop.at_frame);
    out.put(loop.inliers);
    out.put(loop.score);
  }
  return out.finish();
}

Bytes encode(std::span<const LogLine> lines) {
  MessageWriter out(MessageType::kLog);
  out.put_count(lines.size());
  for (const LogLine& line : lines) {
    out.align(8);
    out.put(line.at_frame);
    out.put(static_cast<std::uint32_t>(line.is_warning));
    out.put_count(line.text.size());
    out.put_text(line.text);
  }
  return out.finish();
}

Bytes encode_truth(std::span<const Eigen::Vector3d> positions) {
  MessageWriter out(MessageType::kTruth, 16 + 24 * positions.size());
  out.put_count(positions.size());
  out.align(8);
  for (const Eigen::Vector3d& position : positions) out.put_vector(position);
  return out.finish();
}

Bytes encode(const Alignment& alignment) {
  MessageWriter out(MessageType::kAlignment);
  out.put_similarity(alignment.S_world_truth);
  out.put(alignment.ate_rmse);
  out.put(alignment.pairs);
  return out.finish();
}

Bytes encode(const Status& status) {
  MessageWriter out(MessageType::kStatus);
  out.put(static_cast<std::uint32_t>(status.state));
  out.put(status.done);
  out.put(status.count);
  out.put(status.viewers);
  out.put(status.loop_candidates);
  out.put(status.memory_mb);
  out.put(status.frames_per_s);
  out.put(status.dropped);
  return out.finish();
}

Bytes encode_window(const LiveView& view, const Sim3d& correction) {
  MessageWriter out(MessageType::kWindow, 4096);
  out.put(view.frame_id);
  out.put_similarity(correction);
  out.put_pose<double>(view.T_world_camera.value_or(SE3d()));
  out.put<std::uint32_t>(view.T_world_camera.has_value());
  out.put_count(view.window.size());
  for (const WindowKeyframe& shown : view.window) {
    const Keyframe keyframe =
        to_keyframe(shown.frame_id, shown.T_world_camera, shown.points, view.camera, shown.readout);
    out.put(keyframe.id);
    out.put_pose<double>(keyframe.T_world_camera);
    out.put_count(keyframe.points.size());
    out.align(8);
    out.put_points(keyframe);
  }
  return out.finish();
}

Bytes encode_image(const CompressedImage& image, std::span<const ViewPixel> pixels) {
  MessageWriter out(MessageType::kImage, 64 + 16 * pixels.size() + image.jpeg.size());
  out.put(image.frame_id);
  out.put(static_cast<std::uint32_t>(image.width));
  out.put(static_cast<std::uint32_t>(image.height));
  out.put_count(pixels.size());
  out.put_count(image.jpeg.size());
  for (const ViewPixel& pixel : pixels) {
    out.put(pixel.u);
    out.put(pixel.v);
    out.put(pixel.idepth);
    out.put(static_cast<std::uint32_t>((pixel.is_corner ? 1 : 0) | (pixel.is_candidate ? 2 : 0)));
  }
  out.put_bytes(image.jpeg);
  return out.finish();
}

Keyframe to_keyframe(std::int64_t id, const SE3d& T_world_camera, std::span<const MapPoint> points,
                     const PinholeIntrinsics& camera, const ReadoutMotion& readout) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.T_world_camera = T_world_camera;
  keyframe.points.reserve(points.size());
  for (const MapPoint& point : points) {
    const Eigen::Vector3f position = position_in_camera(camera, readout, point).cast<float>();
    if (!(point.idepth > 0) || !position.allFinite()) continue;
    keyframe.points.push_back(position);
    keyframe.depth_stddev.push_back(point.idepth_stddev / point.idepth);
    keyframe.intensity.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(point.intensity, 0.0f, 255.0f))));
    keyframe.is_corner.push_back(point.is_corner ? 1 : 0);
  }
  return keyframe;
}

std::vector<Message> split(std::span<const std::uint8_t> stream, const std::string& name) {
  std::vector<Message> messages;
  ByteReader in(stream, name);
  while (in.left() > 0) {
    const auto size = in.get<std::uint32_t>();
    const auto type = in.get<std::uint16_t>();
    in.get<std::uint16_t>();
    if (size < kHeaderBytes || size % 8 != 0) throw Error(name, "it is no stream of messages", "it is damaged");
    messages.push_back({static_cast<MessageType>(type), in.get_bytes(size - kHeaderBytes)});
  }
  return messages;
}

Hello decode_hello(std::span<const std::uint8_t> payload, const std::string& name) {
  ByteReader in(payload, name);
  if (in.get_text(4) != kMagic) throw Error(name, "it is no recording of ldso", "give one that `ldso run` wrote");
  const auto version = in.get<std::uint32_t>();
  if (version != kVersion) {
    throw Error(name, "its format is version " + std::to_string(version) + ", not " + std::to_string(kVersion),
                "use the ldso that wrote it, or run the sequence again");
  }
  Hello hello;
  hello.run_id = in.get<std::uint64_t>();
  hello.epoch = in.get<std::uint32_t>();
  hello.mode = static_cast<Mode>(in.get<std::uint8_t>());
  hello.has_control = in.get<std::uint8_t>() != 0;
  in.get<std::uint16_t>();
  hello.camera.width = static_cast<int>(in.get<std::uint32_t>());
  hello.camera.height = static_cast<int>(in.get<std::uint32_t>());
  for (double* x : {&hello.camera.fx, &hello.camera.fy, &hello.camera.cx, &hello.camera.cy}) *x = in.get<double>();
  const PinholeIntrinsics& c = hello.camera;
  if (c.width < 0 || c.height < 0 || !is_sane(c.fx) || !is_sane(c.fy) || !is_sane(c.cx) || !is_sane(c.cy))
    in.fail("its camera is none");
  hello.name = in.get_text(in.get<std::uint32_t>());
  in.get_bytes(in.left() % 8);  // Zeros up to a multiple of 8; the first versions end there.
  if (in.left() > 0) hello.metres_per_unit = in.get<double>();
  if (!(hello.metres_per_unit >= 0) || !is_sane(hello.metres_per_unit)) in.fail("its scale is none");
  return hello;
}

std::span<const std::uint8_t> whole(const Message& message) {
  return {message.payload.data() - kHeaderBytes, message.payload.size() + kHeaderBytes};
}

Keyframe decode_keyframe(std::span<const std::uint8_t> payload, const std::string& name) {
  ByteReader in(payload, name);
  Keyframe keyframe;
  keyframe.id = in.get<std::int64_t>();
  keyframe.timestamp = in.get<double>();
  keyframe.T_world_camera = get_pose(in);
  const auto points = in.get<std::uint32_t>();
  const auto links = in.get<std::uint32_t>();
  get_all(in, links, keyframe.links);
  get_all(in, points, keyframe.points);
  const auto is_point = [](const Eigen::Vector3f& point) { return point.allFinite(); };
  if (!std::all_of(keyframe.points.begin(), keyframe.points.end(), is_point)) in.fail("a point in it is not finite");
  get_all(in, points, keyframe.depth_stddev);
  get_all(in, points, keyframe.intensity);
  get_all(in, points, keyframe.is_corner);
  in.get_bytes(in.left() % 8);  // Zeros up to a multiple of 8; the first versions end there.
  if (in.left() == 0) return keyframe;
  keyframe.segment = static_cast<int>(in.get<std::uint32_t>());
  if (in.get<std::uint32_t>() != 0) get_all(in, points, keyframe.colors);
  return keyframe;
}

Poses decode_poses(std::span<const std::uint8_t> payload, const std::string& name) {
  ByteReader in(payload, name);
  Poses poses;
  poses.at_frame = in.get<std::int64_t>();
  poses.correction = get_similarity(in);
  const auto count = in.get<std::uint32_t>();
  in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto id = in.get<std::int64_t>();
    poses.poses.push_back({id, get_similarity(in)});
  }
  return poses;
}

std::optional<Command> decode_command(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != 1 || bytes[0] < 1 || bytes[0] > 3) return std::nullopt;
  return static_cast<Command>(bytes[0]);
}

}  // namespace ldso::protocol
