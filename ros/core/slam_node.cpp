#include "core/slam_node.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/image_queue.h"
#include "core/map_frame.h"
#include "core/node_counts.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/ros_messages.h"
#include "ldso/io/settings_file.h"
#include "ldso/results_folder.h"
#include "ldso/slam.h"

namespace ldso::ros {
namespace {

/// An image that much earlier than the one before is of another run [ns].
constexpr std::int64_t kBackwards = 1'000'000'000;
constexpr double kNanosecond = 1e-9;

Settings settings_of(const NodeOptions& options) {
  Settings settings;
  set_settings(settings, options.settings);
  settings.validate();
  return settings;
}

Image<float> decode(const NodeImage& image) {
  const RosImage& raw = image.image;
  if (image.compressed_format.empty()) return grey_image(raw, "image");
  return grey_image({raw.data, raw.size}, image.compressed_format, "image");
}

}  // namespace

struct SlamNode::Impl {
  Impl(const NodeOptions& node_options, NodeOutput& node_output)
      : options(node_options),
        settings(settings_of(node_options)),
        output(node_output),
        queue(static_cast<std::size_t>(node_options.queue_size)) {
    if (options.calibration.empty()) return;
    calibration = read_camera_calibration(options.calibration);
    counts.has_camera = true;
  }

  void work();
  /// False if the node ends before there is one.
  bool wait_for_camera();
  void begin_run();
  void open_results();
  void end_run();
  /// Whether the image follows the one before in time; ends the run if time has gone back.
  bool is_in_order(const NodeImage& image);
  void process(const NodeImage& image);
  void publish_map(std::int64_t stamp_ns);
  void refuse(const std::string& problem);
  /// Calls `change(counts)` with nobody else at it.
  template <class Change>
  void change_counts(const Change& change) {
    const std::lock_guard lock(mutex);
    change(counts);
  }

  const NodeOptions options;
  const Settings settings;
  NodeOutput& output;
  ImageQueue queue;
  mutable std::mutex mutex;  ///< Of what follows, up to the blank line.
  std::condition_variable changed;
  std::optional<Calibration> calibration;
  NodeCounts counts;
  bool is_ending = false;
  std::string info_problem;  ///< That was said of a camera_info.

  // Of the thread that works.
  std::unique_ptr<ResultsFolder> results;
  std::unique_ptr<Slam> slam;
  std::vector<std::int64_t> stamps;        ///< Of the frames, by their ids.
  std::vector<std::string> camera_frames;  ///< In tf, likewise.
  std::int64_t last_map_ns = 0;
  int runs = 0;

  std::atomic<bool> must_reset = false;
  std::thread thread;
};

SlamNode::SlamNode(const NodeOptions& options, NodeOutput& output) : impl_(std::make_unique<Impl>(options, output)) {
  impl_->thread = std::thread([this] { impl_->work(); });
}

SlamNode::~SlamNode() { finish(); }

void SlamNode::on_camera_info(const RosCameraInfo& info) {
  LogLevel level = LogLevel::kInfo;
  std::string said;
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->calibration) return;
    try {
      Calibration found = to_calibration(info, has_rectified_images(impl_->options.image_topic), "camera_info");
      said = "calibration by " + found.description;
      for (const std::string& warning : found.warnings) {
        level = LogLevel::kWarning;
        said += "; " + warning;
      }
      impl_->calibration = std::move(found);
      impl_->counts.has_camera = true;
    } catch (const Error& error) {
      if (impl_->info_problem == error.what()) return;
      level = LogLevel::kWarning;
      said = impl_->info_problem = error.what();
    }
  }
  impl_->changed.notify_all();
  impl_->output.log(level, said);
}

void SlamNode::on_image(NodeImage image) {
  const std::size_t left = impl_->queue.push(std::move(image));
  impl_->change_counts([&](NodeCounts& counts) {
    ++counts.images;
    counts.dropped += static_cast<std::int64_t>(left);
  });
}

void SlamNode::reset() { impl_->must_reset = true; }

void SlamNode::finish() {
  if (!impl_->thread.joinable()) return;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_ending = true;
  }
  impl_->changed.notify_all();
  impl_->queue.close(impl_->options.queue_size == 0);
  impl_->thread.join();
}

NodeStatus SlamNode::status() const {
  const std::lock_guard lock(impl_->mutex);
  return status_of(impl_->counts);
}

void SlamNode::Impl::work() {
  if (!wait_for_camera()) return;
  while (const std::optional<NodeImage> image = queue.pop()) {
    try {
      if (must_reset.exchange(false)) end_run();
      if (is_in_order(*image)) process(*image);
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
  end_run();
}

bool SlamNode::Impl::wait_for_camera() {
  std::unique_lock lock(mutex);
  changed.wait(lock, [this] { return calibration || is_ending; });
  return calibration.has_value();
}

void SlamNode::Impl::begin_run() {
  ++runs;
  open_results();
  LogSink log = [this](LogLevel level, const std::string& text) { output.log(level, text); };
  slam = results ? std::make_unique<Slam>(*calibration, settings, results->log(), results->observer())
                 : std::make_unique<Slam>(*calibration, settings, log);
}

/// Of each run after the first one beside those of the first.
void SlamNode::Impl::open_results() {
  if (options.results.empty()) return;
  ResultsFolderOptions folder_options;
  folder_options.name = options.image_topic;
  folder_options.log = [this](LogLevel level, const std::string& text) { output.log(level, text); };
  const std::string folder = options.results + (runs > 1 ? "_" + std::to_string(runs) : "");
  try {
    results = std::make_unique<ResultsFolder>(folder, *calibration, settings, folder_options);
  } catch (const Error& error) {
    output.log(LogLevel::kWarning, std::string("there will be no results: ") + error.what());
  }
}

void SlamNode::Impl::end_run() {
  if (!slam) return;
  if (!stamps.empty()) publish_map(stamps.back());
  SlamResult result = slam->finish();
  slam.reset();
  stamps.clear();
  camera_frames.clear();
  const std::unique_ptr<ResultsFolder> folder = std::move(results);
  try {
    if (folder) folder->write(std::move(result));
  } catch (const Error& error) {
    output.log(LogLevel::kWarning, error.what());
  }
}

bool SlamNode::Impl::is_in_order(const NodeImage& image) {
  if (stamps.empty() || image.stamp_ns > stamps.back()) return true;
  if (stamps.back() - image.stamp_ns < kBackwards) {
    refuse("an image is not later than the one before");
    return false;
  }
  output.log(LogLevel::kWarning, "time has gone back: a new run begins");
  end_run();
  return true;
}

void SlamNode::Impl::process(const NodeImage& image) {
  const auto begin = std::chrono::steady_clock::now();
  const Image<float> grey = decode(image);
  if (!slam) {
    begin_run();
    last_map_ns = image.stamp_ns;
  }
  const FrameRecord record = slam->process(grey.view(), static_cast<double>(image.stamp_ns) * kNanosecond);
  stamps.push_back(image.stamp_ns);
  camera_frames.push_back(options.camera_frame.empty() ? image.frame : options.camera_frame);
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  const std::optional<SE3d> pose = slam->T_world_camera();
  if (pose) output.pose(to_node_pose(image.stamp_ns, camera_frames.back(), *pose, options.rep103));
  if (static_cast<double>(image.stamp_ns - last_map_ns) * kNanosecond >= options.map_period_s)
    publish_map(image.stamp_ns);
  change_counts([&](NodeCounts& all) { all.add(record, elapsed.count()); });
}

void SlamNode::Impl::publish_map(std::int64_t stamp_ns) {
  last_map_ns = stamp_ns;
  const SlamResult map = slam->snapshot();
  std::vector<NodePose> path;
  for (const TimedPose& pose : map.trajectory()) {
    const auto id = static_cast<std::size_t>(pose.frame_id);
    path.push_back(to_node_pose(stamps.at(id), camera_frames.at(id), pose.T_world_camera, options.rep103));
  }
  output.map(stamp_ns, path, to_node_points(map.points(), options.rep103));
}

void SlamNode::Impl::refuse(const std::string& problem) {
  change_counts([](NodeCounts& all) { ++all.refused; });
  output.log(LogLevel::kWarning, problem);
}

std::string info_topic(const NodeOptions& options) { return camera_info_topic(options.image_topic); }

}  // namespace ldso::ros
