#pragma once
// Errors of the TUM-mono benchmark, for ground truth that exists only at the start and at the end of a sequence.
// Engel, Usenko, Cremers, A Photometrically Calibrated Benchmark For Monocular Visual Odometry, arXiv 1607.02555.

#include <optional>

#include "evaluation/association.h"
#include "ldso/sim3.h"

namespace ldso {

/// T_start and T_end map the estimate to the ground truth: least squares over the start and over the end segment.
struct TumMonoError {
  double e_align = 0;         ///< RMS over all poses of |T_start p - T_end p| [unit of the ground truth].
  double e_rmse = 0;          ///< RMS over both segments after one common alignment [unit of the ground truth].
  double e_translation = 0;   ///< e_t: length of the translation of T_drift [unit of the ground truth].
  double e_rotation_deg = 0;  ///< e_r: angle of the rotation of T_drift [deg].
  /// e_s: scale of T_start / scale of T_end. That is one over the scale of T_drift; the benchmark's own evaluation
  /// reports it this way round.
  double e_scale = 1;
  double start_rmse = 0;  ///< RMS of the start segment after its own alignment.
  double end_rmse = 0;    ///< RMS of the end segment after its own alignment.
  std::size_t start_pairs = 0;
  std::size_t end_pairs = 0;
  Sim3d T_start;  ///< Maps the estimate to the start segment.
  Sim3d T_drift;  ///< T_end * T_start^-1.
};

/// The time [s] that parts the start segment from the end segment: the middle of the longest gap of the ground truth,
/// if that gap covers the middle of the sequence and a third of its time; else there are no segments and it is empty.
std::optional<double> find_segment_split(const Trajectory& truth);

/// `pairs` as from associate_by_time. For an estimate that runs backwards in time the start is what comes first in it.
/// Throws ldso::Error if a segment has fewer than 3 pairs: the estimate has to reach both ends of the sequence.
TumMonoError tum_mono_error(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                            double split_time);

}  // namespace ldso
