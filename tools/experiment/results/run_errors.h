#pragma once
// The errors of a job's trajectories against the ground truth, kept in a file beside them.

#include <cstdint>
#include <filesystem>
#include <string>

#include "experiment/jobs/job_result.h"
#include "ldso/io/trajectory_file.h"

namespace ldso {

/// Ground truth of a sequence, as several jobs share it.
struct GroundTruth {
  Trajectory poses;
  std::uint64_t fingerprint = 0;  ///< Of the poses: what was measured against others is measured again.
  std::string problem;            ///< Why there are no poses.
};

/// The truth of a job: its own file or what the sequence carries. Never throws: `problem` says what is wrong.
GroundTruth load_ground_truth(const ExperimentJob& job);

struct RunErrors {
  TrajectoryErrors errors, odometry_errors;
  bool is_lost = false;  ///< The trajectory does not reach what its metric needs.
  std::string reason;    ///< Of that, or why there are no errors.
};

/// Reads and measures trajectory.txt and, if `has_odometry`, trajectory_odometry.txt of the folder; takes the result
/// from errors.json if that was made of the same files and the same ground truth, else writes it, if the folder can be
/// written. Throws ldso::Error for a trajectory that cannot be read.
RunErrors measure_run(const std::filesystem::path& folder, const ExperimentJob& job, const GroundTruth& truth,
                      bool has_odometry);

/// Errors of an evaluation by name.
TrajectoryErrors measure_trajectory(const Trajectory& estimate, const Trajectory& truth);

}  // namespace ldso
