#include "viewer/recording/recorded_map.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Timestamps in a trajectory have nine decimals.
constexpr double kSameTime = 2e-9;

}  // namespace

RecordedMap decode_recorded_map(const Bytes& recording, const std::string& name) {
  using protocol::MessageType;
  RecordedMap map;
  std::map<std::int64_t, Sim3d> corrected;
  Sim3d correction;
  bool has_begun = false;
  for (const protocol::Message& message : protocol::split(recording, name)) {
    if (message.type == MessageType::kHello) {
      map = {};
      map.camera = protocol::decode_hello(message.payload, name).camera;
      has_begun = true;
    } else if (message.type == MessageType::kKeyframe) {
      map.keyframes.push_back(protocol::decode_keyframe(message.payload, name));
    } else if (message.type == MessageType::kPoses) {
      const protocol::Poses poses = protocol::decode_poses(message.payload, name);
      correction = poses.correction;
      for (const KeyframePose& pose : poses.poses) corrected[pose.keyframe_id] = pose.S_world_keyframe;
    }
  }
  if (!has_begun) throw Error(name, "it is no recording of ldso", "give one that `ldso run` wrote");
  std::stable_sort(map.keyframes.begin(), map.keyframes.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const protocol::Keyframe& keyframe : map.keyframes) {
    const auto pose = corrected.find(keyframe.id);
    map.corrected.push_back(pose != corrected.end() ? pose->second : correction * Sim3d(keyframe.T_world_camera));
  }
  return map;
}

Bytes with_scale(const Bytes& recording, double metres_per_unit) {
  Bytes result;
  for (const protocol::Message& message : protocol::split(recording, "recording")) {
    if (message.type == protocol::MessageType::kHello) {
      protocol::Hello hello = protocol::decode_hello(message.payload, "recording");
      hello.metres_per_unit = metres_per_unit;
      const Bytes scaled = encode(hello);
      result.insert(result.end(), scaled.begin(), scaled.end());
    } else {
      const std::span<const std::uint8_t> bytes = protocol::whole(message);
      result.insert(result.end(), bytes.begin(), bytes.end());
    }
  }
  return result;
}

void keep_frames_of(const Trajectory& trajectory, RecordedMap& map) {
  std::set<double> times;
  for (const StampedPose& pose : trajectory) times.insert(pose.timestamp);
  RecordedMap kept;
  kept.camera = map.camera;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const double time = map.keyframes[i].timestamp;
    const auto found = times.lower_bound(time - kSameTime);
    if (found == times.end() || *found > time + kSameTime) continue;
    kept.keyframes.push_back(std::move(map.keyframes[i]));
    kept.corrected.push_back(map.corrected[i]);
  }
  map = std::move(kept);
}

void scale_map(double factor, RecordedMap& map) {
  for (protocol::Keyframe& keyframe : map.keyframes) {
    keyframe.T_world_camera.translation() *= factor;
    for (Eigen::Vector3f& point : keyframe.points) point *= static_cast<float>(factor);
  }
  for (Sim3d& pose : map.corrected) pose = Sim3d(pose.rotation(), pose.translation() * factor, pose.scale());
}

RecordedMap read_recorded_map(const std::filesystem::path& path) {
  return decode_recorded_map(read_bytes(path), path.string());
}

}  // namespace ldso
