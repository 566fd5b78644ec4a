#pragma once

// A trajectory as Python sees it, and what it can be made of.

#include <pybind11/pybind11.h>

#include <cstdint>
#include <vector>

#include "ldso/io/trajectory_file.h"
#include "ldso/slam.h"

namespace ldso::python {

struct NumberedTrajectory {
  Trajectory poses;
  std::vector<std::int64_t> frame_ids;  ///< Of each pose; empty if unknown.
};

NumberedTrajectory to_numbered(const std::vector<TimedPose>& poses);

/// From a ldso.Trajectory, rows of a TUM file as an array of shape (N, 8), or the path of a file or a sequence that
/// carries one. Throws Error if it is none of them.
Trajectory to_trajectory(const pybind11::object& given);

}  // namespace ldso::python
