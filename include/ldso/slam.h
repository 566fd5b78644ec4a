#pragma once
// The whole system as one class: images in, camera poses and a sparse map out.
//
//   ldso::Slam slam(calibration, ldso::Settings{});
//   for (...) slam.process(image, timestamp);
//   const ldso::SlamResult result = slam.finish();

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/log.h"
#include "ldso/observer.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "ldso/sim3.h"

namespace ldso {

/// A frame's pose in the world of the map.
struct TimedPose {
  std::int64_t frame_id = 0;
  double timestamp = 0;  ///< [s]
  SE3d T_world_camera;
};

/// A point of the map in the world.
struct WorldPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [map units]
  float idepth_stddev = 0;                             ///< Of the inverse depth in the host keyframe [1 / map unit].
  float intensity = 0;                                 ///< Irradiance, 0..255.
  std::int64_t keyframe_id = -1;                       ///< The host keyframe (its frame_id).
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();     ///< Where the host sees it (rectified image) [px].
};

/// Time spent in one stage of the processing.
struct StageTime {
  std::int64_t calls = 0;
  double total_ms = 0;
  double worst_ms = 0;
};

/// Which poses of the keyframes to take: those of the odometry, or those after loop closing (the same if no loop was
/// closed).
enum class Correction { kNone, kLoops };

/// Everything that is left after the last frame. Poses and points have the free scale of a single camera.
struct SlamResult {
  std::vector<FrameRecord> frames;  ///< Of all frames, in the order in which they came.
  /// With poses and points as the odometry left them, in the order of their frame ids (constraints are not kept).
  std::vector<KeyframeUpdate> keyframes;
  /// Poses of `keyframes` after loop closing, as similarities, for their own units differ; empty without loops.
  std::vector<Sim3d> corrected;
  std::vector<LoopRecord> loops;          ///< All pairs of keyframes that looked alike, accepted or refused.
  VarianceFactors loop_variance_factors;  ///< Learned from the loops.
  double loop_bytes_per_keyframe = 0;     ///< What loop closing kept in memory for a keyframe, on average.
  PinholeIntrinsics camera;               ///< Of the rectified images, as estimated: the points' pixels are its own.
  /// Frames with which a map was there: that of the first map, then one a restart. Frames before them that waited for
  /// the map may have got their poses afterwards.
  std::vector<std::int64_t> initializations;
  int restarts = 0;  ///< How often the map was lost and a new one begun.
  int skipped = 0;   ///< Frames that could not be used.
  /// A calibration that explains the images better than the given one, if they contradict it. Frames that come one by
  /// one cannot begin anew with it: take it for the next run, or let run_sequence() (sequence_run.h) do so by itself.
  std::optional<Calibration> better_calibration;
  std::map<std::string, StageTime> stage_times;

  /// Parts of the map that share no coordinates: each map that was begun after a loss, but for those that a loop has
  /// joined to another. 0 is the part with the most keyframes, the others follow in the order of time. 0 parts if there
  /// is no keyframe.
  int parts(Correction correction = Correction::kLoops) const;

  /// Poses of all frames of a part that have one, in the order of `frames`: that of its reference keyframe, as finally
  /// estimated, times its own relative to it. A frame without a known keyframe or with a pose that is not finite has
  /// none; the first frame of a map has that of the keyframe it became.
  std::vector<TimedPose> trajectory(Correction correction = Correction::kLoops, int part = 0) const;

  /// Poses of the keyframes of a part, in their order.
  std::vector<TimedPose> keyframe_trajectory(Correction correction = Correction::kLoops, int part = 0) const;

  /// All points of a part with a positive, finite inverse depth.
  std::vector<WorldPoint> points(Correction correction = Correction::kLoops, int part = 0) const;
};

/// Monocular direct SLAM, one image at a time. The same images and settings give the same bits, whatever
/// `Settings::threads` is. One object must not be used from several threads at once; several objects may.
class Slam {
 public:
  /// `log` hears of losses and restarts, and of a calibration that the images contradict; it may be empty. `observer`
  /// hears of everything while it happens (to show it, for instance: ldso/viewer.h); there need not be one. Throws
  /// Error if the calibration or a setting makes no sense.
  Slam(const Calibration& calibration, const Settings& settings, LogSink log = {},
       std::shared_ptr<RunObserver> observer = {});
  ~Slam();
  /// One that was moved from can be assigned to and destroyed; all else throws Error.
  Slam(Slam&&) noexcept;
  Slam& operator=(Slam&&) noexcept;
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  /// One grey image as the camera took it, of the calibration's size: 8 bit, 16 bit (full range) or grey levels in
  /// 0..255. `timestamp` [s] is passed through. An exposure that is not finite and positive counts as unknown.
  /// Frame ids count the calls from 0. Throws Error for a wrong size, and after finish(); a frame that is
  /// refused leaves the system as it was.
  FrameRecord process(ImageView<const std::uint8_t> image, double timestamp, std::optional<double> exposure_ms = {});
  FrameRecord process(ImageView<const std::uint16_t> image, double timestamp, std::optional<double> exposure_ms = {});
  FrameRecord process(ImageView<const float> image, double timestamp, std::optional<double> exposure_ms = {});

  /// Pose of the newest frame as now estimated; none while it is not tracked. Closed loops are taken account of a few
  /// keyframes later, at fixed points of the sequence.
  std::optional<SE3d> T_world_camera() const;

  /// The camera of the rectified images that tracking works on.
  PinholeIntrinsics rectified_camera() const;

  /// The result of the frames so far, as if no other followed, but for what only the end brings: the loops have no
  /// matches, and refused ones and times are missing. Poses and points of the sliding window are as now estimated. The
  /// run goes on as if nobody had asked. It is a copy of the whole map: once a second is often.
  SlamResult snapshot() const;

  /// Ends the run and hands over its result. No frame can follow.
  SlamResult finish();

 private:
  struct Impl;
  Impl& impl() const;
  std::unique_ptr<Impl> impl_;  ///< None once it was moved from.
};

}  // namespace ldso
