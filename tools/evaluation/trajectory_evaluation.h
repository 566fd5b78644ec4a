#pragma once
// All metrics of one estimate against one ground truth: associate, align, measure.

#include <optional>
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/association.h"
#include "evaluation/kitti_drift.h"
#include "evaluation/relative_error.h"
#include "evaluation/scale_drift.h"
#include "evaluation/statistics.h"
#include "evaluation/tum_mono_error.h"
#include "ldso/sim3.h"

namespace ldso {

struct EvaluationOptions {
  AlignmentMode alignment = AlignmentMode::kSim3;
  double max_time_difference = 0.01;  ///< Of two poses that are paired [s].
  bool pair_by_index = false;         ///< Pose i with pose i, for files without time stamps.
  RelativeErrorOptions relative;
};

/// Lengths are in the unit of the ground truth (metres).
struct EvaluationResult {
  std::size_t estimate_poses = 0;
  std::size_t truth_poses = 0;  ///< Finite ones.
  PosePairs pairs;              ///< In the order in which the estimate was made.
  AlignmentMode alignment = AlignmentMode::kSim3;
  Sim3d S_truth_estimate;  ///< Maps the world of the estimate to that of the ground truth.
  double path_length = 0;  ///< Of the ground truth, along the associated poses.

  std::vector<double> absolute_errors;              ///< Of each pair.
  Statistics absolute;                              ///< ATE.
  std::optional<Statistics> relative_translation;   ///< RPE; none if there are no more pairs than delta,
  std::optional<Statistics> relative_rotation_deg;  ///< or the ground truth is of both ends only.
  RelativeErrorOptions relative_options;

  std::optional<ScaleDrift> scale_drift;
  std::optional<KittiDrift> kitti_drift;
  bool truth_of_both_ends = false;       ///< The ground truth has a start and an end segment and nothing between.
  std::optional<TumMonoError> tum_mono;  ///< Only if the ground truth has a start and an end segment and the
                                         ///< estimate reaches both.

  /// ATE rmse as a share of the path [%]; 0 if the camera never moved.
  double ate_percent_of_path() const;
};

/// Throws ldso::Error if the estimate holds a pose that is not finite, if the two do not overlap in time (with both
/// ranges), or if fewer than 3 poses have a partner.
EvaluationResult evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                     const EvaluationOptions& options = {});

}  // namespace ldso
