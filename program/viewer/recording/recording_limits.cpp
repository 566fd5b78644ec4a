#include "viewer/recording/recording_limits.h"

#include <algorithm>

#include "viewer/map/pose_history.h"

namespace ldso {
namespace {

using protocol::Message;
using protocol::MessageType;

constexpr std::size_t kFrameBytes = 112;
constexpr std::size_t kTruthBytes = 24;
constexpr std::size_t kCountBytes = 8;  ///< Before the records of a list: their number, and zeros.

struct Counts {
  std::size_t points = 0, frames = 0, truth = 0;
};

std::size_t records_in(const Message& message, std::size_t record) {
  return message.payload.size() < kCountBytes ? 0 : (message.payload.size() - kCountBytes) / record;
}

/// Corrected poses with fewer steps in between.
PoseHistory thinned_history(const std::vector<Message>& messages, std::size_t most, const std::string& name) {
  PoseHistory history(most);
  for (const Message& message : messages) {
    if (message.type == MessageType::kPoses) history.add(protocol::decode_poses(message.payload, name));
  }
  return history;
}

Counts count(const std::vector<Message>& messages, const std::string& name) {
  Counts counts;
  for (const Message& message : messages) {
    if (message.type == MessageType::kKeyframe)
      counts.points += protocol::decode_keyframe(message.payload, name).points.size();
    if (message.type == MessageType::kFrames) counts.frames += records_in(message, kFrameBytes);
    if (message.type == MessageType::kTruth) counts.truth += records_in(message, kTruthBytes);
  }
  return counts;
}

int stride_for(std::size_t count, std::size_t limit) {
  return static_cast<int>((count + limit - 1) / std::max<std::size_t>(limit, 1));
}

template <class T>
void keep_every(std::vector<T>& values, std::size_t stride) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); i += stride) values[kept++] = values[i];
  values.resize(kept);
}

Bytes thinned_keyframe(const Message& message, int stride, const std::string& name) {
  protocol::Keyframe keyframe = protocol::decode_keyframe(message.payload, name);
  const auto step = static_cast<std::size_t>(stride);
  keep_every(keyframe.points, step);
  keep_every(keyframe.depth_stddev, step);
  keep_every(keyframe.intensity, step);
  keep_every(keyframe.is_corner, step);
  keep_every(keyframe.colors, step);
  return encode(keyframe);
}

/// Of a message that is a list of records of one size, those that `keeps` wants.
template <class Predicate>
Bytes thinned_records(const Message& message, std::size_t record, const Predicate& keeps) {
  ByteWriter kept;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < records_in(message, record); ++i) {
    const auto bytes = message.payload.subspan(kCountBytes + i * record, record);
    if (!keeps(i, bytes)) continue;
    kept.put_bytes(bytes);
    ++count;
  }
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(2 * kCountBytes + kept.size()));
  out.put(static_cast<std::uint16_t>(message.type));
  out.put(std::uint16_t{0});
  out.put(count);
  out.put(std::uint32_t{0});
  out.put_bytes(kept.bytes());
  return out.take();
}

/// By their ids: a later record of the same frame stays with the first one.
Bytes thinned_frames(const Message& message, int stride, const std::string& name) {
  return thinned_records(message, kFrameBytes, [&](std::size_t, std::span<const std::uint8_t> bytes) {
    return ByteReader(bytes, name).get<std::int64_t>() % stride == 0;
  });
}

Bytes thinned_truth(const Message& message, int stride) {
  return thinned_records(message, kTruthBytes, [&](std::size_t i, std::span<const std::uint8_t>) {
    return i % static_cast<std::size_t>(stride) == 0;
  });
}

}  // namespace

LimitedRecording limit_recording(const Bytes& recording, const RecordingLimits& limits, const std::string& name) {
  const std::vector<Message> messages = protocol::split(recording, name);
  const Counts counts = count(messages, name);
  LimitedRecording limited;
  limited.points = counts.points;
  limited.points_stride = std::max(1, stride_for(counts.points, limits.points));
  limited.frames_stride = std::max(1, stride_for(counts.frames, limits.frames));
  limited.truth_stride = std::max(1, stride_for(counts.truth, limits.truth));
  const auto put = [&](std::span<const std::uint8_t> bytes) {
    limited.bytes.insert(limited.bytes.end(), bytes.begin(), bytes.end());
  };
  for (const Message& message : messages) {
    if (message.type == MessageType::kLog || message.type == MessageType::kPoses) continue;
    if (message.type == MessageType::kHello) {
      protocol::Hello hello = protocol::decode_hello(message.payload, name);
      hello.mode = protocol::Mode::kReplay;
      hello.has_control = false;
      put(encode(hello));
    } else if (message.type == MessageType::kKeyframe && limited.points_stride > 1) {
      put(thinned_keyframe(message, limited.points_stride, name));
    } else if (message.type == MessageType::kFrames && limited.frames_stride > 1) {
      put(thinned_frames(message, limited.frames_stride, name));
    } else if (message.type == MessageType::kTruth && limited.truth_stride > 1) {
      put(thinned_truth(message, limited.truth_stride));
    } else {
      put(protocol::whole(message));
    }
  }
  const PoseHistory history = thinned_history(messages, limits.poses, name);
  for (const protocol::Poses& step : history.steps()) put(encode(step));
  return limited;
}

}  // namespace ldso
