#pragma once

// A run as others see it: recorded from its first to its last frame and, if wanted, shown on a page meanwhile.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ldso/io/trajectory_file.h"
#include "ldso/log.h"
#include "viewer/map/live_map.h"
#include "viewer/run_control.h"
#include "viewer/run_feed.h"
#include "viewer/server/server.h"

namespace ldso {

/// What a frame cost.
struct FrameCost {
  std::int64_t frame_id = 0;
  double frame_ms = 0;     ///< Time that the odometry took for it.
  int points = 0;          ///< Active points of the window afterwards.
  double exposure_ms = 0;  ///< 0 if unknown.
};

/// Where the ground truth lies in the map of the frames so far; nothing if that cannot be told (yet).
using TruthAligner = std::function<std::optional<protocol::Alignment>(const Trajectory& estimate)>;

struct LiveRunOptions {
  std::string name;                     ///< Of the sequence.
  std::optional<ServerOptions> server;  ///< None: only recorded.
  std::vector<Eigen::Vector3d> truth;   ///< Positions of the ground truth's cameras, in order.
  bool has_control = true;              ///< Whether pages can pause it. Live runs wait for nobody.
  bool is_paused = false;               ///< From before the first frame on.
  TruthAligner align;                   ///< Called on the server's thread; must not throw.
};

class LiveRun {
 public:
  /// Throws Error if the server cannot listen where it should.
  explicit LiveRun(LiveRunOptions options);
  ~LiveRun();

  /// To be given to the run.
  std::shared_ptr<RunObserver> observer() const { return feed_; }
  /// A message of the run's log. From any thread.
  void log(LogLevel level, const std::string& text) { feed_->add_log(level, text); }
  /// To be called by the run before the first and after each frame: waits while a page has paused it. `stop` ends the
  /// waiting. `count`: 0 if unknown; `dropped`: frames of `done` that were not processed.
  void after_frame(int done, int count, const std::atomic<bool>& stop, int dropped = 0);
  /// The last frame is done.
  void finish();

  /// None without a server.
  std::string url() const { return server_ ? server_->url() : std::string(); }
  /// Time that the run spent waiting because a page had paused it.
  double paused_seconds() const { return control_.paused_seconds(); }
  /// All of the run so far, to be kept as a file.
  Bytes recording();
  /// Of all frames so far, in the order in which they came; frames that were skipped cost nothing.
  std::vector<FrameCost> frame_costs();

 private:
  /// Calls it with a map that is up to date, where nobody else uses it.
  void with_map(const std::function<void(LiveMap&)>& function);
  void tick(LiveMap& map, std::size_t viewers);
  void show(const LiveView& view, LiveMap& map);
  void update_status(LiveMap& map, std::size_t viewers);
  void update_alignment(LiveMap& map);

  using Clock = std::chrono::steady_clock;

  LiveRunOptions options_;
  std::shared_ptr<RunFeed> feed_;
  RunControl control_;
  std::atomic<int> done_{0}, count_{0}, dropped_{0};
  std::atomic<bool> finished_{false};
  LiveMap map_;  ///< The server's, if there is one.

  // Of the server's thread:
  protocol::Status status_;
  Clock::time_point last_view_, last_status_, next_alignment_;
  std::size_t aligned_frames_ = 0;
  std::uint64_t aligned_poses_ = 0;

  std::unique_ptr<Server> server_;  ///< The last member: its thread uses the others.
};

}  // namespace ldso
