#pragma once

// How monocular odometry starts: from the first frame's points and their displacements in a later frame the
// motion between the two (up to scale) and the points' inverse depths. Unlike DSO's initializer it
// does not start from inverse depth 1 everywhere but from patches that move freely, which also tell turning
// from moving: without parallax there is nothing to start from, and it waits.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "ldso/settings.h"
#include "odometry/init/joint_alignment.h"
#include "odometry/init/patch_tracker.h"
#include "odometry/init/two_view.h"
#include "util/thread_pool.h"

namespace ldso {

/// A point of the first frame.
struct InitialPoint {
  float u = 0, v = 0;         ///< Level-0 pixel.
  float idepth = 0;           ///< Mean over the good points: 1.
  float idepth_variance = 0;  ///< With the pose held fixed.
  bool is_good = false;       ///< Seen again, explained, and its inverse depth is determined.
  bool is_corner = false;     ///< As selected.
};

struct Initialization {
  std::int64_t first_frame_id = -1;
  std::int64_t current_frame_id = -1;
  SE3d T_current_first;
  /// I_current = (exposure_current / exposure_first) e^a I_first + b.
  double a = 0, b = 0;
  std::vector<InitialPoint> points;
  double median_parallax = 0;   ///< Of the good points [px].
  double direction_stddev = 0;  ///< Of the direction of translation [rad].
};

class Initializer {
 public:
  enum class Status {
    kWaiting,    ///< See reason().
    kReady,      ///< result() holds; add no more frames before reset().
    kRestarted,  ///< The frame added is the new first frame; see reason().
  };

  /// `pool` must outlive this. `prior`: precision of the brightness priors between frames whose exposure is
  /// known (none otherwise).
  Initializer(const PinholeIntrinsics& camera, const InitializerSettings& settings, const SelectionSettings& selection,
              ThreadPool& pool, const BrightnessPrior& prior = {});
  ~Initializer();

  /// The first frame becomes the reference. Throws Error if the frame's size is not the camera's.
  Status add(std::shared_ptr<const PreparedFrame> frame);

  /// Valid after kReady.
  const Initialization& result() const { return result_; }
  /// Why it waits or restarted, for people; empty when ready.
  const std::string& reason() const { return reason_; }
  std::shared_ptr<const PreparedFrame> first_frame() const { return first_; }
  std::shared_ptr<const PreparedFrame> newest_frame() const { return newest_; }

  /// Forgets everything.
  void reset();

 private:
  struct Track;
  struct Motion;
  void set_reference(std::shared_ptr<const PreparedFrame> frame);
  Status wait(std::string reason);
  Status restart(std::shared_ptr<const PreparedFrame> frame, const std::string& reason);
  Status judge(const std::shared_ptr<const PreparedFrame>& frame, const std::vector<PatchMatch>& matches);
  std::vector<PatchMatch> track(const PreparedFrame& frame);
  std::vector<PatchPrediction> predict_all(const SO3d& step) const;
  PatchPrediction predict(const Track& track, const SO3d& step, const SE3d& T_predicted) const;
  static BrightnessTransfer brightness_of(const std::vector<PatchMatch>& matches);
  SE3d predicted_pose(const SO3d& step) const;
  void remember(const std::vector<PatchMatch>& matches);
  Motion fit(const std::vector<PatchMatch>& matches);
  void fit_motion_with_translation(const std::vector<TwoViewMatch>& pairs, Motion& result);
  TwoViewMatch two_view_match(std::size_t index, const PatchMatch& match) const;
  double wanted_parallax() const;
  std::string too_little_parallax(double parallax) const;
  std::string objection(const Motion& motion) const;
  std::string refine(const PreparedFrame& frame);
  JointState joint_start();
  std::string publish(const PreparedFrame& frame, const JointFit& fit);

  PinholeIntrinsics camera_;
  InitializerSettings settings_;
  SelectionSettings selection_;
  ThreadPool& pool_;
  BrightnessPrior prior_;

  std::shared_ptr<const PreparedFrame> first_;
  std::shared_ptr<const PreparedFrame> newest_;
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<Track> tracks_;
  std::unique_ptr<PatchTracker> tracker_;
  std::unique_ptr<JointAlignment> joint_;
  /// Poses of the newest frame and the one before relative to the first, in units of the median depth;
  /// pure rotations while no translation is known.
  SE3d T_newest_first_;
  SE3d T_previous_first_;
  bool moving_ = false;            ///< Both have translations.
  BrightnessTransfer brightness_;  ///< From the first to the newest frame.
  double tracked_ = 1;             ///< Share of the points found in the newest frame.
  int frames_ = 0;                 ///< Since the first.

  Initialization result_;
  std::string reason_;
};

}  // namespace ldso
