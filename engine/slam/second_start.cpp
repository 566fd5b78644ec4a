#include "slam/second_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "slam/packed_keyframe.h"
#include "slam/replace_record.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Frames that the second odometry may be behind: each holds its pyramid.
constexpr std::size_t kMostBehind = 4;
/// Fewer frames tell nothing.
constexpr std::size_t kLeastCompared = 20;
/// A first map that needed more frames to begin is doubtful: the images could be explained in several ways.
constexpr int kPromptStart = 12;

Settings patient(Settings settings) {
  settings.initializer.good_parallax_angle = settings.revision.second_parallax_angle;
  return settings;
}

}  // namespace

SecondStart::SecondStart(const Odometry& odometry, const Settings& settings, ThreadPool& pool)
    : settings_(settings.revision),
      pool_(pool),
      patient_(patient(settings)),
      map_{odometry.unstarted(patient_, pool), {}, {}, -1},
      queue_(kMostBehind),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

SecondStart::~SecondStart() {
  thread_.request_stop();
  queue_.close();
}

void SecondStart::work(const std::stop_token& stop) {
  while (const auto item = queue_.pop()) {
    if (stop.stop_requested() || !failure_.empty()) continue;
    try {
      process(*item);
    } catch (const std::exception& failure) {
      failure_ = failure.what();
    }
  }
}

void SecondStart::process(const Item& item) {
  OdometryOutput output = map_.odometry->process(item.frame);
  const bool begins = start_ < 0 && output.frame.state == TrackingState::kTracked;
  if (begins && item.first_begins && item.is_doubtful) {
    // Both would be the same map. This one begins once more, from the images that follow.
    map_.odometry = map_.odometry->unstarted(patient_, pool_);
    output = map_.odometry->process(item.frame);
  } else if (begins) {
    start_ = output.frame.frame_id;
  }
  map_.records.push_back(output.frame);
  for (const FrameRecord& late : output.late) replace_record(map_.records, late);
  if (output.frame.is_keyframe && item.raw) images_.push_back(std::make_shared<const PackedFrame>(*item.raw));
  for (FinishedKeyframe& keyframe : output.finished) {
    pack(images_, keyframe);
    map_.keyframes.push_back(std::move(keyframe));
  }
}

bool SecondStart::add(const std::shared_ptr<const PreparedFrame>& frame, const std::shared_ptr<const RawFrame>& raw,
                      const FrameRecord& first) {
  const bool is_tracked = first.state == TrackingState::kTracked;
  const bool begins = is_tracked && first_start_ < 0;
  if (begins) first_start_ = first.frame_id;
  ++(first_start_ < 0 ? waited_ : age_);
  // A loss has its own remedies; and who begins with the same frame comes to the same map.
  is_over_ = is_over_ || (first_start_ >= 0 && (!is_tracked || start_ == first_start_));
  if (!is_over_) queue_.push({frame, raw, begins, waited_ > kPromptStart});
  return is_over_ || age_ >= settings_.second_frames;
}

std::optional<SecondMap> SecondStart::finish(const std::vector<FrameRecord>& first, std::string& verdict) {
  if (is_over_) thread_.request_stop();
  queue_.close();
  if (thread_.joinable()) thread_.join();
  if (is_over_ || start_ == first_start_ || !failure_.empty()) return std::nullopt;
  const double ratio = residual_ratio(first);
  if (!(ratio <= settings_.most_residual)) return std::nullopt;
  verdict = "a map that began later, with more parallax, explains the images better (residuals " +
            std::to_string(std::lround(100 * (ratio - 1))) + " %): it takes the place of the first one";
  map_.start = start_;
  return std::move(map_);
}

double SecondStart::residual_ratio(const std::vector<FrameRecord>& first_records) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (map_.odometry->restarts() > 0) return kNone;
  std::unordered_map<std::int64_t, float> second;
  for (const FrameRecord& record : map_.records) {
    if (record.state == TrackingState::kTracked) second[record.frame_id] = record.residual_rmse;
  }
  std::vector<double> ratios;
  for (const FrameRecord& first : first_records) {
    if (first.state != TrackingState::kTracked) continue;
    const auto found = second.find(first.frame_id);
    if (found == second.end() && !ratios.empty()) return kNone;
    if (found != second.end() && first.residual_rmse > 0 && found->second > 0)
      ratios.push_back(found->second / first.residual_rmse);
  }
  return ratios.size() < kLeastCompared ? kNone : upper_median(ratios);
}

}  // namespace ldso
