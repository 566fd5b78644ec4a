#include "evaluation/doubts.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "evaluation/relative_error.h"
#include "io/datasets/time_unit.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// Motions whose rotations are compared, at least, so that their mean says something.
constexpr std::size_t kFewestMotions = 10;

/// Motions are this share of the trajectory long: far enough to turn.
constexpr std::size_t kMotionsInAll = 20;

/// Disagreement of rotations that is worth an explanation [deg], and the share of it that another reading may leave.
constexpr double kLeastDisagreementDeg = 0.2;
constexpr double kExplainedShare = 0.3;

/// The rotation of a line whose quaternion was read with w last, read with w first.
SO3d with_w_first(const SO3d& rotation) {
  const Eigen::Quaterniond q = rotation.quaternion();
  return SO3d(Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()));
}

/// The rotations of the paired poses of one trajectory.
using Rotations = std::vector<SO3d>;

Rotations reordered(const Rotations& rotations) {
  Rotations result;
  std::transform(rotations.begin(), rotations.end(), std::back_inserter(result), with_w_first);
  return result;
}

/// Mean angle by which the motions of both differ [deg].
double mean_disagreement_deg(const Rotations& a, const Rotations& b) {
  const std::size_t length = std::max<std::size_t>(1, a.size() / kMotionsInAll);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + length < a.size(); i += length, ++count) {
    const SO3d motion_a = a[i].inverse() * a[i + length];
    const SO3d motion_b = b[i].inverse() * b[i + length];
    sum += rotation_angle_deg(motion_a.inverse() * motion_b);
  }
  return count < kFewestMotions ? 0 : sum / static_cast<double>(count);
}

/// "estimate" or "ground truth" if that seems to have w first; empty if neither does.
std::string find_w_first(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs) {
  Rotations p, q;
  for (const PosePair& pair : pairs) {
    p.push_back(estimate[pair.estimate].T_world_camera.rotation());
    q.push_back(truth[pair.truth].T_world_camera.rotation());
  }
  const double as_read = mean_disagreement_deg(p, q);
  if (as_read < kLeastDisagreementDeg) return "";
  if (mean_disagreement_deg(reordered(p), q) < kExplainedShare * as_read) return "estimate";
  return mean_disagreement_deg(p, reordered(q)) < kExplainedShare * as_read ? "ground truth" : "";
}

}  // namespace

std::vector<std::string> doubts_about_times(const Trajectory& trajectory, const std::string& name) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) times.push_back(pose.timestamp);
  if (look_like_frame_numbers(times))
    return {name + ": the time stamps look like frame numbers; they are taken for seconds"};
  const double unit = seconds_per_unit(times);
  if (unit == 1) return {};
  return {name + ": the time stamps look like " +
          (unit == 1e-3   ? "milliseconds"
           : unit == 1e-6 ? "microseconds"
                          : "nanoseconds") +
          "; they are taken for seconds"};
}

std::vector<std::string> doubts_about_pairs(const Trajectory& estimate, const Trajectory& truth,
                                            const EvaluationResult& result, const EvaluationOptions& options) {
  std::vector<std::string> doubts;
  // A truth of lower rate, or of both ends only, has fewer poses than the estimate; that is no mistake.
  const std::size_t possible = std::min(result.estimate_poses, result.truth_poses);
  if (!result.truth_of_both_ends && result.pairs.size() * 2 < possible) {
    doubts.push_back("only " + std::to_string(result.pairs.size()) + " of " + std::to_string(possible) +
                     " poses have a partner within " + format_text("%g", options.max_time_difference) +
                     " s: are both of the same recording, with the same clock? --max-diff allows for more");
  }
  if (const std::string file = find_w_first(estimate, truth, result.pairs); !file.empty()) {
    doubts.push_back("the quaternions of the " + file +
                     " seem to have w first (the rotations agree then); `qx qy qz qw` is expected");
  }
  return doubts;
}

}  // namespace ldso
