#pragma once

// Aligns a new frame to the newest keyframe: direct image alignment of the semi-dense depth map, coarse to fine,
// over pose and brightness (DSO section 3.1).

#include <memory>
#include <vector>

#include "ldso/settings.h"
#include "odometry/state/brightness.h"
#include "odometry/tracking/coarse_depth_map.h"
#include "odometry/tracking/keyframe_policy.h"
#include "util/thread_pool.h"

namespace ldso {

struct AlignmentResult {
  bool good = false;
  SE3d T_new_ref;
  Brightness brightness;           ///< Of the new frame.
  std::vector<double> level_rmse;  ///< Root mean robust energy of each level, finest first; NaN: not reached.
  double in_view = 0;              ///< Share of the finest level's points that fall into the new image.
  double rmse() const { return level_rmse.empty() ? 0.0 : level_rmse.front(); }
};

/// The frame before the new one, for the motion during the readout of a rolling shutter.
struct PreviousFrame {
  SE3d T_previous_ref;
  double readout_share = 0;  ///< The readout, in units of the time between both frames; 0: global shutter.
};

class CoarseTracker {
 public:
  CoarseTracker(const TrackingSettings& settings, ThreadPool& pool) : settings_(settings), pool_(pool) {}

  /// From now on frames are aligned to the newest keyframe of the window.
  void set_reference(const Window& window);

  /// Aligns `frame` starting from one hypothesis; `prior` holds its brightness. Gives up at the first level that is
  /// worse than `limits` (root mean energies by level, finest first; empty: no limits) times the setting `good_ratio`.
  AlignmentResult align(const PreparedFrame& frame, const SE3d& T_new_ref, const Brightness& brightness,
                        const BrightnessPrior& prior, const std::vector<double>& limits,
                        const PreviousFrame& previous = {}) const;

  /// Mean energy of a frame on the coarsest level, where a hypothesis begins; infinite if it shows too little there.
  double start_energy(const PreparedFrame& frame, const SE3d& T_new_ref, const Brightness& brightness,
                      const BrightnessPrior& prior, const PreviousFrame& previous) const;

  /// Pixel motion and brightness change of an aligned frame.
  FrameMotion motion(const PreparedFrame& frame, const AlignmentResult& result) const;

  /// How much of the reference's structure an aligned frame shows: on the finest level, or, if that is less than
  /// `wanted`, on the next one. Blur and noise take it from the finest first.
  double agreement(const PreparedFrame& frame, const AlignmentResult& result, double wanted) const;

  /// By how far a motion shifts the image of a point at the mean depth, about [px].
  double shift_px(const SE3d& motion) const;

  const CoarseDepthMap& depth_map() const { return map_; }

 private:
  struct Estimate;
  struct LevelSystem;
  LevelSystem evaluate(const PreparedFrame& frame, int level, const Estimate& estimate, double cutoff) const;
  LevelSystem align_level(const PreparedFrame& frame, int level, Estimate& estimate) const;

  TrackingSettings settings_;
  ThreadPool& pool_;
  CoarseDepthMap map_;
  std::shared_ptr<const PreparedFrame> ref_frame_;
  PinholeIntrinsics camera_;
  Brightness ref_brightness_;
  double ref_exposure_ = 1;
};

}  // namespace ldso
