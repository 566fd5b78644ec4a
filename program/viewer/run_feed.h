#pragma once

// Where a run leaves what it has to show, and a viewer fetches it at a time of its own. Leaving something is an append
// under a lock that is only ever held for appends and for the swap by which everything is fetched: the run waits for
// nobody. What belongs to the map is kept until it is fetched; of the views only the newest is.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ldso/log.h"
#include "ldso/observer.h"
#include "viewer/map/live_map.h"
#include "viewer/map/protocol.h"

namespace ldso {

class RunFeed final : public RunObserver {
 public:
  /// `hello`: what pages are told at the start, but for camera and epoch.
  explicit RunFeed(protocol::Hello hello) : hello_(std::move(hello)) {}

  void on_start(const PinholeIntrinsics& camera) override;
  void on_frame(FrameEvent event) override;
  void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics& camera) override;
  void on_loops(LoopEvent event) override;
  bool wants_view() override { return wants_view_.load(std::memory_order_relaxed); }
  void on_view(LiveView view) override;
  /// A message of the run's log.
  void add_log(LogLevel level, const std::string& text);

  /// Moves everything to the map; the newest view, if there is one, is returned. From one thread at a time.
  std::optional<LiveView> fetch(LiveMap& map);

  /// Nobody will fetch any more: what is left from now on is dropped. For a run that outlives its viewer.
  void close();

  /// From now on, until one has come, the next frame's view is wanted.
  void request_view() { wants_view_.store(true, std::memory_order_relaxed); }

  int loop_candidates() const { return loop_candidates_.load(std::memory_order_relaxed); }

 private:
  struct Inbox {
    std::optional<protocol::Hello> start;
    std::vector<FrameEvent> frames;
    std::vector<protocol::Keyframe> keyframes;
    std::vector<LoopEvent> loops;
    std::vector<protocol::LogLine> log;
    std::optional<LiveView> view;
  };

  /// Calls it with the inbox under the lock, unless the feed is closed.
  template <class Leave>
  void leave(Leave leave);

  std::mutex mutex_;
  Inbox inbox_;
  bool is_closed_ = false;
  protocol::Hello hello_;
  std::int64_t newest_frame_ = -1;
  std::atomic<bool> wants_view_{false};
  std::atomic<int> loop_candidates_{0};
};

}  // namespace ldso
