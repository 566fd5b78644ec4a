#include "viewer/live_run.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "io/images/image_file.h"
#include "viewer/map/shrink.h"
#include "viewer/server/random_id.h"

namespace ldso {
namespace {

constexpr std::chrono::milliseconds kViewInterval(66);
constexpr std::chrono::milliseconds kStatusInterval(250);
constexpr std::chrono::milliseconds kAlignmentInterval(1000);
/// The share of the time that aligning with the ground truth may take: one over this.
constexpr int kAlignmentShare = 50;

/// Of the camera's image on the page: sharp enough, and some 50 kB each.
constexpr int kMostImageWidth = 720;
constexpr int kJpegQuality = 80;

/// Weight of the newest rate in the one that is shown: an average over about two seconds.
constexpr double kNewRateShare = 0.25;
/// Frames per second that count as none.
constexpr float kLeastRate = 0.05f;
/// Frames after which a run without a server tidies its feed up.
constexpr int kFetchInterval = 50;

/// What the program holds at the moment: resident [MB]; 0 where it cannot be told.
double process_memory_mb() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return file ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6 : 0;
}

protocol::Hello make_hello(const LiveRunOptions& options) {
  protocol::Hello hello;
  hello.run_id = random_id();
  hello.has_control = options.server && options.has_control;
  hello.name = options.name;
  return hello;
}

}  // namespace

LiveRun::LiveRun(LiveRunOptions options)
    : options_(std::move(options)), feed_(std::make_shared<RunFeed>(make_hello(options_))) {
  if (!options_.truth.empty()) map_.set_latest(LatestSlot::kTruth, protocol::encode_truth(options_.truth));
  map_.start(make_hello(options_));  // For pages that come before the first frame.
  if (options_.is_paused) control_.command(protocol::Command::kPause);
  if (!options_.server) return;
  server_ = std::make_unique<Server>(
      *options_.server, map_, [this](LiveMap& map, std::size_t viewers) { tick(map, viewers); },
      [this](protocol::Command command) {
        if (options_.has_control) control_.command(command);
      });
}

LiveRun::~LiveRun() {
  server_.reset();  // Shows how it ended.
  feed_->close();
}

void LiveRun::after_frame(int done, int count, const std::atomic<bool>& stop, int dropped) {
  dropped_.store(dropped);
  done_.store(done);
  count_.store(count);
  if (server_) {
    control_.wait(stop);
  } else if (done % kFetchInterval == 0) {
    feed_->fetch(map_);
  }
}

void LiveRun::finish() {
  finished_.store(true);
  if (!server_) feed_->fetch(map_);
}

void LiveRun::with_map(const std::function<void(LiveMap&)>& function) {
  const auto use = [&](LiveMap& map) {
    feed_->fetch(map);
    function(map);
  };
  if (server_) {
    server_->call(use);
  } else {
    use(map_);
  }
}

Bytes LiveRun::recording() {
  Bytes recording;
  with_map([&](LiveMap& map) {
    update_alignment(map);
    recording = map.snapshot();
  });
  return recording;
}

std::vector<FrameCost> LiveRun::frame_costs() {
  std::vector<FrameCost> costs;
  with_map([&](const LiveMap& map) {
    for (const FrameEvent& event : map.frame_events()) {
      if (!event.is_late) costs.push_back({event.frame.frame_id, event.frame_ms, event.points, event.exposure_ms});
    }
  });
  return costs;
}

void LiveRun::tick(LiveMap& map, std::size_t viewers) {
  const std::optional<LiveView> view = feed_->fetch(map);
  if (view && viewers > 0) show(*view, map);
  const Clock::time_point now = Clock::now();
  if (viewers > 0 && now - last_view_ >= kViewInterval) {
    last_view_ = now;
    feed_->request_view();
  }
  update_status(map, viewers);
  if (viewers > 0 && now >= next_alignment_) {
    update_alignment(map);
    const auto took = Clock::now() - now;
    next_alignment_ = now + std::max<Clock::duration>(kAlignmentInterval, kAlignmentShare * took);
  }
}

void LiveRun::show(const LiveView& view, LiveMap& map) {
  map.set_latest(LatestSlot::kWindow, protocol::encode_window(view, map.correction()));
  const Image<float> image = view.image();
  const Image<float> small = shrink(image.view(), kMostImageWidth);
  map.set_latest(LatestSlot::kImage, protocol::encode_image({view.frame_id, image.width(), image.height(),
                                                             encode_grey_jpeg(small.view(), kJpegQuality)},
                                                            view.pixels));
}

void LiveRun::update_status(LiveMap& map, std::size_t viewers) {
  const Clock::time_point now = Clock::now();
  protocol::Status status = status_;
  status.viewers = static_cast<std::uint32_t>(viewers);
  status.state = finished_.load()       ? protocol::RunState::kFinished
                 : control_.is_paused() ? protocol::RunState::kPaused
                                        : protocol::RunState::kRunning;
  if (now - last_status_ >= kStatusInterval) {
    const std::chrono::duration<double> elapsed = now - last_status_;
    const auto done = static_cast<std::uint32_t>(done_.load());
    const double rate = done >= status.done ? (done - status.done) / elapsed.count() : 0;
    status.frames_per_s = static_cast<float>(status.frames_per_s + kNewRateShare * (rate - status.frames_per_s));
    if (status.frames_per_s < kLeastRate) status.frames_per_s = 0;
    status.done = done;
    status.count = static_cast<std::uint32_t>(count_.load());
    status.dropped = static_cast<std::uint32_t>(dropped_.load());
    status.loop_candidates = static_cast<std::uint32_t>(feed_->loop_candidates());
    status.memory_mb = static_cast<float>(process_memory_mb());
    last_status_ = now;
  }
  if (status == status_ && map.frames() > 0) return;
  status_ = status;
  map.set_latest(LatestSlot::kStatus, encode(status));
}

void LiveRun::update_alignment(LiveMap& map) {
  const bool is_new = map.frames() != aligned_frames_ || map.pose_revision() != aligned_poses_;
  if (!options_.align || !is_new) return;
  aligned_frames_ = map.frames();
  aligned_poses_ = map.pose_revision();
  if (const auto alignment = options_.align(map.trajectory())) {
    map.set_latest(LatestSlot::kAlignment, encode(*alignment));
  }
}

}  // namespace ldso
