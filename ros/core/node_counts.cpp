#include "core/node_counts.h"

#include <tuple>
#include <utility>

#include "core/node_options.h"

namespace ldso::ros {
namespace {

std::pair<NodeLevel, std::string> judgement(const NodeCounts& counts) {
  if (!counts.has_camera) return {NodeLevel::kWarning, "waiting for camera_info"};
  if (counts.images == 0) return {NodeLevel::kWarning, "waiting for images"};
  if (counts.processed == 0 && counts.refused > 0) return {NodeLevel::kError, "no image could be used"};
  if (counts.state == TrackingState::kTracked) return {NodeLevel::kOk, "tracking"};
  const std::string because = counts.reason.empty() ? "" : ": " + counts.reason;
  if (counts.state == TrackingState::kInitializing) return {NodeLevel::kWarning, "waiting for a map" + because};
  return {NodeLevel::kError, "lost" + because};
}

}  // namespace

void NodeCounts::add(const FrameRecord& record, double ms) {
  losses += state == TrackingState::kTracked && record.state == TrackingState::kLost ? 1 : 0;
  state = record.state;
  reason = record.reason;
  keyframes += record.is_keyframe ? 1 : 0;
  ++processed;
  total_ms += ms;
}

NodeStatus status_of(const NodeCounts& counts) {
  NodeStatus status;
  std::tie(status.level, status.message) = judgement(counts);
  const double mean_ms = counts.processed > 0 ? counts.total_ms / static_cast<double>(counts.processed) : 0;
  status.figures = {{"images", std::to_string(counts.images)},
                    {"processed", std::to_string(counts.processed)},
                    {"dropped", std::to_string(counts.dropped)},
                    {"refused", std::to_string(counts.refused)},
                    {"keyframes", std::to_string(counts.keyframes)},
                    {"losses", std::to_string(counts.losses)},
                    {"mean time of an image [ms]", number_text(mean_ms)}};
  return status;
}

}  // namespace ldso::ros
