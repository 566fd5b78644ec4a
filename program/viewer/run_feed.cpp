#include "viewer/run_feed.h"

#include <algorithm>
#include <utility>

namespace ldso {

template <class Leave>
void RunFeed::leave(Leave leave) {
  const std::lock_guard lock(mutex_);
  if (!is_closed_) leave(inbox_);
}

void RunFeed::close() {
  Inbox dropped;  // Let go of outside of the lock.
  wants_view_.store(false, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  std::swap(dropped, inbox_);
}

void RunFeed::on_start(const PinholeIntrinsics& camera) {
  leave([&](Inbox& inbox) {
    ++hello_.epoch;
    hello_.camera = camera;
    newest_frame_ = -1;
    Inbox fresh;
    fresh.start = hello_;
    fresh.log = std::move(inbox.log);
    inbox = std::move(fresh);
  });
}

void RunFeed::on_frame(FrameEvent event) {
  leave([&](Inbox& inbox) {
    newest_frame_ = std::max(newest_frame_, event.frame.frame_id);
    inbox.frames.push_back(std::move(event));
  });
}

void RunFeed::on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics& camera) {
  protocol::Keyframe shown =
      protocol::to_keyframe(keyframe.frame_id, keyframe.T_world_camera, keyframe.points, camera, keyframe.readout);
  shown.timestamp = keyframe.timestamp;
  shown.segment = keyframe.segment;
  for (const KeyframeConstraint& constraint : keyframe.constraints) shown.links.push_back(constraint.keyframe_id);
  leave([&](Inbox& inbox) { inbox.keyframes.push_back(std::move(shown)); });
}

void RunFeed::on_loops(LoopEvent event) {
  loop_candidates_.store(event.candidates, std::memory_order_relaxed);
  leave([&](Inbox& inbox) { inbox.loops.push_back(std::move(event)); });
}

void RunFeed::on_view(LiveView view) {
  wants_view_.store(false, std::memory_order_relaxed);
  std::optional<LiveView> previous(std::move(view));  // What it replaces is let go of outside of the lock.
  leave([&](Inbox& inbox) { inbox.view.swap(previous); });
}

void RunFeed::add_log(LogLevel level, const std::string& text) {
  leave([&](Inbox& inbox) { inbox.log.push_back({newest_frame_, level == LogLevel::kWarning, text}); });
}

std::optional<LiveView> RunFeed::fetch(LiveMap& map) {
  Inbox inbox;
  {
    const std::lock_guard lock(mutex_);
    std::swap(inbox, inbox_);
  }
  if (inbox.start) map.start(std::move(*inbox.start));
  for (const protocol::Keyframe& keyframe : inbox.keyframes) map.add(keyframe);
  for (FrameEvent& frame : inbox.frames) map.add(std::move(frame));
  for (LoopEvent& loops : inbox.loops) map.add(std::move(loops));
  for (const protocol::LogLine& line : inbox.log) map.add(line);
  return std::move(inbox.view);
}

}  // namespace ldso
