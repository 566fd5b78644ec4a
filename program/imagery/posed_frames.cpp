#include "imagery/posed_frames.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ldso {
namespace {

/// Timestamps in a trajectory have nine decimals.
constexpr double kSameTime = 2e-9;

/// Frames that are farther apart say little of how the camera moved at one of them [s].
constexpr double kLongestGap = 0.5;

}  // namespace

std::vector<FramePose> posed_frames(const Trajectory& trajectory, const FrameSource& sequence) {
  std::map<double, std::int64_t> id_of;
  for (int i = 0; i < sequence.size(); ++i) id_of[sequence.timestamp(i)] = i;
  std::vector<FramePose> frames;
  for (const StampedPose& pose : trajectory) {
    const auto found = id_of.lower_bound(pose.timestamp - kSameTime);
    if (found != id_of.end() && found->first <= pose.timestamp + kSameTime)
      frames.push_back({found->second, pose.timestamp, pose.T_world_camera});
  }
  std::sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return frames;
}

ReadoutMotion readout_motion(const std::vector<FramePose>& frames, std::size_t index, double readout_s) {
  const auto is_near = [&](std::size_t other) {
    return std::abs(frames[other].timestamp - frames[index].timestamp) <= kLongestGap;
  };
  const FramePose& before = frames[index > 0 && is_near(index - 1) ? index - 1 : index];
  const FramePose& after = frames[index + 1 < frames.size() && is_near(index + 1) ? index + 1 : index];
  const double seconds = after.timestamp - before.timestamp;
  if (readout_s == 0 || seconds == 0) return ReadoutMotion::Zero();
  return readout_s / seconds * (after.T_world_camera.inverse() * before.T_world_camera).log();
}

}  // namespace ldso
