#include "viewer/map/live_map.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "util/disjoint_sets.h"

namespace ldso {
namespace {

/// Frames in one message.
constexpr std::size_t kMostFrames = 4096;

std::size_t index_of(LatestSlot slot) { return static_cast<std::size_t>(slot); }

}  // namespace

void LiveMap::start(protocol::Hello hello) {
  hello_ = std::move(hello);
  ++starts_;
  messages_.clear();
  frames_.clear();
  poses_.clear();
  history_.clear();
  loops_.clear();
  newest_segment_ = 0;
  pose_revision_ = 0;
  correction_ = Sim3d();
  newest_frame_ = -1;
  for (const LatestSlot slot : {LatestSlot::kAlignment, LatestSlot::kWindow, LatestSlot::kImage}) {
    latest_[index_of(slot)] = {};
  }
}

void LiveMap::add(const protocol::Keyframe& keyframe) {
  PoseEntry& entry = poses_[keyframe.id];
  entry.T_world_camera = keyframe.T_world_camera;
  entry.segment = keyframe.segment;
  newest_segment_ = std::max(newest_segment_, keyframe.segment);
  add_message(encode(keyframe));
}

void LiveMap::add(FrameEvent frame) {
  newest_frame_ = std::max(newest_frame_, frame.frame.frame_id);
  frames_.push_back(std::move(frame));
}

void LiveMap::add(LoopEvent loops) {
  ++pose_revision_;
  correction_ = loops.correction;
  for (const KeyframePose& pose : loops.poses) {
    PoseEntry& entry = poses_[pose.keyframe_id];
    entry.S_world_keyframe = pose.S_world_keyframe;
    entry.revision = pose_revision_;
  }
  history_.add({newest_frame_, correction_, loops.poses});
  std::vector<protocol::Loop> closed;
  for (const LoopRecord& loop : loops.accepted) {
    loops_.emplace_back(loop.keyframe_id, loop.candidate_id);
    closed.push_back(
        {loop.keyframe_id, loop.candidate_id, newest_frame_, loop.inliers, static_cast<float>(loop.score)});
  }
  if (!closed.empty()) add_message(protocol::encode(std::span<const protocol::Loop>(closed)));
}

void LiveMap::add(const protocol::LogLine& line) { add_message(protocol::encode(std::span(&line, 1))); }

void LiveMap::add_message(Bytes message) { messages_.push_back(std::make_shared<const Bytes>(std::move(message))); }

void LiveMap::set_latest(LatestSlot slot, Bytes message) {
  Latest& latest = latest_[index_of(slot)];
  ++latest.revision;
  latest.message = std::make_shared<const Bytes>(std::move(message));
}

SharedBytes LiveMap::frames_from(std::size_t& position) const {
  const std::size_t count = std::min(frames_.size() - position, kMostFrames);
  const std::span<const FrameEvent> part(frames_.data() + position, count);
  position += count;
  return std::make_shared<const Bytes>(protocol::encode(part));
}

SharedBytes LiveMap::poses_since(std::uint64_t& revision) const {
  protocol::Poses changed{newest_frame_, correction_, {}};
  for (const auto& [id, entry] : poses_) {
    if (entry.revision > revision) changed.poses.push_back({id, entry.S_world_keyframe});
  }
  revision = pose_revision_;
  return std::make_shared<const Bytes>(encode(changed));
}

std::vector<SharedBytes> LiveMap::next(MapCursor& cursor, std::size_t most_bytes) const {
  std::vector<SharedBytes> out;
  std::size_t bytes = 0;
  const auto take = [&](SharedBytes message) {
    bytes += message->size();
    out.push_back(std::move(message));
  };
  if (starts_ == 0) return out;
  if (cursor.start != starts_) {
    cursor = MapCursor{starts_, 0, 0, 0, {}};
    take(std::make_shared<const Bytes>(encode(hello_)));
  }
  while (cursor.messages < messages_.size() && bytes < most_bytes) take(messages_[cursor.messages++]);
  while (cursor.frames < frames_.size() && bytes < most_bytes) take(frames_from(cursor.frames));
  if (cursor.poses == 0 && pose_revision_ > 0) {
    // One that has nothing gets all that came before, for its slider.
    for (const protocol::Poses& step : history_.steps()) take(std::make_shared<const Bytes>(encode(step)));
    cursor.poses = pose_revision_;
  }
  if (cursor.poses < pose_revision_) take(poses_since(cursor.poses));
  for (std::size_t i = 0; i < kLatestSlots; ++i) {
    if (latest_[i].revision <= cursor.latest[i]) continue;
    cursor.latest[i] = latest_[i].revision;
    take(latest_[i].message);
  }
  return out;
}

Bytes LiveMap::snapshot() const {
  MapCursor cursor;
  cursor.start = starts_;
  for (std::size_t i = 0; i < kLatestSlots; ++i) {
    const bool lasts = i == index_of(LatestSlot::kTruth) || i == index_of(LatestSlot::kAlignment);
    if (!lasts) cursor.latest[i] = latest_[i].revision;
  }
  Bytes all = encode(hello_);
  for (const SharedBytes& message : next(cursor, std::numeric_limits<std::size_t>::max())) {
    all.insert(all.end(), message->begin(), message->end());
  }
  return all;
}

std::vector<bool> LiveMap::in_main_part() const {
  const auto count = static_cast<std::size_t>(newest_segment_) + 1;
  const auto segment_of = [&](std::int64_t keyframe) {
    const auto found = poses_.find(keyframe);
    return static_cast<std::size_t>(found != poses_.end() ? found->second.segment : 0);
  };
  DisjointSets parts(count);
  for (const auto& [a, b] : loops_) parts.join(segment_of(a), segment_of(b));
  std::vector<std::size_t> sizes(count, 0);
  for (const auto& [id, entry] : poses_) ++sizes[parts.find(static_cast<std::size_t>(entry.segment))];
  const auto largest = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<bool> is_in(count);
  for (std::size_t i = 0; i < count; ++i) is_in[i] = parts.find(i) == largest;
  return is_in;
}

Trajectory LiveMap::trajectory() const {
  const std::vector<bool> is_shown = in_main_part();
  std::map<std::int64_t, StampedPose> by_id;
  for (const FrameEvent& event : frames_) {
    const FrameRecord& frame = event.frame;
    if (!event.T_world_camera) continue;
    const auto pose = poses_.find(frame.keyframe_id);
    // A keyframe that has not left the window is of the newest segment.
    if (!is_shown[static_cast<std::size_t>(pose != poses_.end() ? pose->second.segment : newest_segment_)]) continue;
    Sim3d S = correction_ * Sim3d(*event.T_world_camera);
    if (pose != poses_.end()) {
      const PoseEntry& entry = pose->second;
      S = (entry.revision > 0 ? entry.S_world_keyframe : correction_ * Sim3d(entry.T_world_camera)) *
          Sim3d(frame.T_keyframe_frame);
    }
    by_id[frame.frame_id] = {frame.timestamp, SE3d(S.rotation(), S.translation())};
  }
  Trajectory trajectory;
  for (const auto& [id, pose] : by_id) trajectory.push_back(pose);
  return trajectory;
}

}  // namespace ldso
