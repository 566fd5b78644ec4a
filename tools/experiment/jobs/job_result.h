#pragma once
// What has become of a job: pending, finished or failed, with its errors, counts and times.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/jobs/job.h"

namespace ldso {

enum class RunState {
  kPending,   ///< Not started, running, or interrupted: the runner will (re)start it.
  kFinished,  ///< With a trajectory over the sequence.
  kFailed,    ///< Crashed, killed or lost; it will not be repeated, and its error counts as infinite.
};

/// "pending", "finished", "failed".
std::string to_string(RunState state);
/// The reverse; throws ldso::Error for any other name.
RunState parse_run_state(const std::string& name);

/// Errors of one trajectory. What does not exist for its ground truth is missing. See docs/evaluation.md.
struct TrajectoryErrors {
  std::optional<double> ate;          ///< RMSE after Sim(3) alignment [m].
  std::optional<double> rpe;          ///< RPE of consecutive poses, translation, RMSE [m].
  std::optional<double> rpe_deg;      ///< RPE, rotation, RMSE [deg].
  std::optional<double> t_rel;        ///< KITTI [%].
  std::optional<double> r_rel;        ///< KITTI [deg/m].
  std::optional<double> scale_drift;  ///< Last third against the first, at least 1.
  std::optional<double> e_align;      ///< TUM-mono [m].
  std::optional<double> e_t;          ///< TUM-mono [m].
  std::optional<double> e_r;          ///< TUM-mono [deg].
  std::optional<double> e_s;          ///< TUM-mono, a factor.
  bool operator==(const TrajectoryErrors&) const = default;
};

/// visit(name, member) for each member of `errors`, which may be const. The names are those of the results files.
template <class Errors, class Visitor>
void visit_errors(Errors& errors, Visitor visit) {
  visit("ate_m", errors.ate);
  visit("rpe_m", errors.rpe);
  visit("rpe_deg", errors.rpe_deg);
  visit("t_rel_percent", errors.t_rel);
  visit("r_rel_deg_per_m", errors.r_rel);
  visit("scale_drift", errors.scale_drift);
  visit("e_align_m", errors.e_align);
  visit("e_t_m", errors.e_t);
  visit("e_r_deg", errors.e_r);
  visit("e_s", errors.e_s);
}

/// Time spent in one stage of the pipeline.
struct RunStage {
  std::int64_t calls = 0;
  double total_ms = 0;
};

/// What run.json says beside the trajectory.
struct RunFigures {
  std::optional<double> frames;            ///< Of the sequence as it was played.
  std::optional<double> frames_with_pose;  ///< Of these.
  std::optional<double> keyframes;
  std::optional<double> points;
  std::optional<double> restarts;  ///< Maps begun anew after the camera was lost.
  std::optional<double> loops_closed;
  std::optional<double> wall_s;
  std::optional<double> frames_per_s;
  std::optional<double> peak_memory_mb;
};

/// As visit_errors().
template <class Figures, class Visitor>
void visit_run_figures(Figures& figures, Visitor visit) {
  visit("frames", figures.frames);
  visit("frames_with_pose", figures.frames_with_pose);
  visit("keyframes", figures.keyframes);
  visit("points", figures.points);
  visit("restarts", figures.restarts);
  visit("loops_closed", figures.loops_closed);
  visit("wall_s", figures.wall_s);
  visit("frames_per_s", figures.frames_per_s);
  visit("peak_memory_mb", figures.peak_memory_mb);
}

struct JobResult {
  ExperimentJob job;
  RunState state = RunState::kPending;
  /// Why it failed; of a finished job why it has no errors; of a pending one what is odd about its files.
  std::string reason;
  TrajectoryErrors errors;           ///< Of the final trajectory. None if it failed.
  TrajectoryErrors odometry_errors;  ///< Before loop closing; of a run without closed loops the same.
  RunFigures run;
  std::map<std::string, RunStage> stages;  ///< By the name in run.json, e.g. "keyframe/select".
};

/// An error that figures and tables show.
struct ErrorKind {
  std::string_view name;  ///< Part of file names: "ate", "e_align", ...
  std::string_view title;
  std::string_view symbol;  ///< Short, for axes and columns: "ATE", "e_t".
  std::string_view unit;    ///< Empty for factors.
  std::optional<double> TrajectoryErrors::*member;
  bool is_factor = false;  ///< 1 is perfect, and 2 as bad as 0.5: both are shown as 2.
};

/// The error that ranks the runs of a metric: ATE or e_align.
const ErrorKind& main_error(JobMetric metric);

inline constexpr ErrorKind kAteError{"ate", "Absolute trajectory error", "ATE", "m", &TrajectoryErrors::ate};
inline constexpr ErrorKind kAlignmentError{"e_align", "Alignment error", "e_align", "m", &TrajectoryErrors::e_align};
inline constexpr ErrorKind kTranslationDrift{"e_t", "Translational drift", "e_t", "m", &TrajectoryErrors::e_t};
inline constexpr ErrorKind kRotationDrift{"e_r", "Rotational drift", "e_r", "deg", &TrajectoryErrors::e_r};
inline constexpr ErrorKind kScaleDrift{"e_s", "Scale drift", "max(e_s, 1/e_s)", "", &TrajectoryErrors::e_s, true};
inline constexpr ErrorKind kKittiTranslation{"t_rel", "KITTI translational drift", "t_rel", "%",
                                             &TrajectoryErrors::t_rel};
inline constexpr ErrorKind kKittiRotation{"r_rel", "KITTI rotational drift", "r_rel", "deg/m",
                                          &TrajectoryErrors::r_rel};
inline constexpr ErrorKind kRelativeTranslation{"rpe_translation", "Relative pose error, translation", "RPE", "m",
                                                &TrajectoryErrors::rpe};
inline constexpr ErrorKind kRelativeRotation{"rpe_rotation", "Relative pose error, rotation", "RPE", "deg",
                                             &TrajectoryErrors::rpe_deg};

/// All errors that tables of a metric show, the main one first.
std::vector<const ErrorKind*> error_kinds(JobMetric metric);

/// "ATE [m]"
std::string label_of(const ErrorKind& kind);

enum class Trajectories { kFinal, kBeforeLoops };

/// How a run counts in figures and comparisons: its error; infinite if it failed; nothing if it is pending or could
/// not be measured.
std::optional<double> counted_error(const JobResult& result, const ErrorKind& kind,
                                    Trajectories which = Trajectories::kFinal);

}  // namespace ldso
