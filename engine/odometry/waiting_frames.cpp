#include "odometry/waiting_frames.h"

#include <algorithm>
#include <cstdint>

#include "odometry/tracking/frame_record.h"

namespace ldso {
namespace {

/// Frames that are kept: a second of most cameras. Longer ago the camera may have been anywhere.
constexpr std::size_t kMostFrames = 30;

}  // namespace

void WaitingFrames::add(const PreparedFrame& frame) {
  frames_.emplace_back(frame);
  if (frames_.size() > kMostFrames) frames_.pop_front();
}

std::vector<FrameRecord> WaitingFrames::track(const Window& window, const FrameTracker& tracker, double least_in_view) {
  // Backwards from the newest keyframe, whose depths are the reference: each frame lies near the one after it, or where
  // an even motion from the first keyframe on puts it.
  const Keyframe &first = *window.keyframes.front(), &last = *window.keyframes.back();
  const SE3d::Tangent motion = (first.state.T_c_w() * last.state.T_c_w().inverse()).log();
  const auto steps = static_cast<double>(std::max<std::int64_t>(1, last.id() - first.id()));
  std::vector<FrameRecord> records;
  AlignmentResult found;  // Of the frame after the one in hand.
  found.brightness = last.state.brightness();
  std::shared_ptr<const PreparedFrame> next = last.frame;
  double next_time = next->timestamp;
  for (; !frames_.empty(); frames_.pop_back()) {
    const auto frame = std::make_shared<const PreparedFrame>(frames_.back().unpack());
    FrameRecord record = new_record(*frame);
    if (frame->id == first.id()) {
      record_keyframe(record);
      records.push_back(record);
      continue;
    }
    if (!same_image(*frame, *next)) {
      const double share = static_cast<double>(last.id() - frame->id) / steps;
      const AlignmentResult result =
          tracker.align_from({found.T_new_ref, SE3d::exp(share * motion)}, *frame, found.brightness,
                             tracker.previous_frame(frame->timestamp, next_time, found.T_new_ref));
      if (!result.good || result.in_view < least_in_view) continue;
      found = result;
      next = frame;
    }
    next_time = frame->timestamp;
    record_pose(last, found.T_new_ref, found.rmse(), found.brightness, record);
    records.push_back(record);
  }
  return records;
}

}  // namespace ldso
