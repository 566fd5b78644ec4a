#pragma once
// An SVG of the aligned estimate over the ground truth, seen along the axis of least motion, and the error over time.

#include <filesystem>
#include <optional>
#include <string>

#include "evaluation/trajectory_evaluation.h"

namespace ldso {

struct PictureOptions {
  std::string title;  ///< E.g. the sequence; figures of the error are appended.
  std::string estimate_label = "estimate";
  std::string truth_label = "ground truth";
  bool error_panel = true;  ///< Error over time beneath the map.
  bool has_times = true;    ///< False: time stamps are indices, and the panel says so.
};

/// The picture as SVG text. `result` is that of evaluate_trajectory for the same two trajectories.
/// The map shows the two coordinate axes with the largest motion, at equal scale, in the world of the ground truth.
std::string trajectory_picture(const Trajectory& estimate, const Trajectory& truth, const EvaluationResult& result,
                               const PictureOptions& options = {});

/// The estimate alone, in its own world and unit. Throws ldso::Error if it is empty.
std::string trajectory_picture(const Trajectory& estimate, const PictureOptions& options = {});

/// An estimate before and after loop closing over the ground truth, each aligned by Sim(3) over the whole; to the start
/// segment if the ground truth is of both ends only. Throws ldso::Error as evaluate_trajectory.
std::string loop_picture(const Trajectory& before, const Trajectory& after, const Trajectory& truth,
                         const std::string& title);

/// The same without a ground truth, in the world and the unit of the map. Throws ldso::Error if one of them is empty.
std::string loop_picture(const Trajectory& before, const Trajectory& after, const std::string& title);

/// Writes the same as trajectory_picture() to a file. Throws ldso::Error if it cannot be written.
void write_trajectory_picture(const std::filesystem::path& path, const Trajectory& estimate, const Trajectory& truth,
                              const EvaluationResult& result, const PictureOptions& options = {});
void write_trajectory_picture(const std::filesystem::path& path, const Trajectory& estimate,
                              const PictureOptions& options = {});

}  // namespace ldso
