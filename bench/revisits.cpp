#include "revisits.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <span>

#include "view_overlap.h"

namespace ldso {
namespace {

/// Of both directions the smaller; 0 if they are turned too far or nothing is known.
double common_share(const KeyframeRun& run, int a, int b, const RevisitOptions& options) {
  const RunKeyframe &from = run.keyframes[a], &to = run.keyframes[b];
  if (!from.T_truth_camera || !to.T_truth_camera || !(from.depth > 0) || !(to.depth > 0)) return 0;
  const SE3d T_b_a = to.T_truth_camera->inverse() * *from.T_truth_camera;
  if (T_b_a.rotation().log().norm() * 180 / std::numbers::pi > options.angle_deg) return 0;
  return std::min(overlap(T_b_a, from.depth, run.camera), overlap(T_b_a.inverse(), to.depth, run.camera));
}

/// Whether a place was left and come back to.
bool is_apart(const KeyframeRun& run, int earlier, int later, const RevisitOptions& options) {
  const RunKeyframe &a = run.keyframes[earlier], &b = run.keyframes[later];
  return a.frame_id < b.frame_id && std::abs(b.timestamp - a.timestamp) >= options.seconds &&
         !std::binary_search(b.neighbours.begin(), b.neighbours.end(), earlier);
}

/// Indices of the keyframes in the order of their frames: they do not leave the window in it.
std::vector<int> in_time(const KeyframeRun& run) {
  std::vector<int> order(run.keyframes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return run.keyframes[a].frame_id < run.keyframes[b].frame_id; });
  return order;
}

/// Cuts keyframes one after the other into pieces of about the same number.
void add_pieces(const KeyframeRun& run, std::span<const int> keyframes, double longest,
                std::vector<Stretch>& stretches) {
  const auto time = [&](int keyframe) { return run.keyframes[keyframe].timestamp; };
  const double seconds = std::abs(time(keyframes.back()) - time(keyframes.front()));
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(seconds / longest)));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = keyframes.size() * i / count, end = keyframes.size() * (i + 1) / count;
    if (end > begin)
      stretches.push_back(
          {run.keyframes[keyframes[begin]].frame_id, run.keyframes[keyframes[end - 1]].frame_id, false});
  }
}

}  // namespace

bool sees_same(const KeyframeRun& run, int a, int b, const RevisitOptions& options) {
  return common_share(run, a, b, options) >= options.overlap;
}

std::optional<int> best_revisited(const KeyframeRun& run, int index, const RevisitOptions& options) {
  double most = options.overlap;
  std::optional<int> best;
  for (int i = 0; i < static_cast<int>(run.keyframes.size()); ++i) {
    if (!is_apart(run, i, index, options)) continue;
    const double share = common_share(run, i, index, options);
    if (share < most) continue;
    most = share;
    best = i;
  }
  return best;
}

int index_of(const KeyframeRun& run, std::int64_t frame_id) {
  const auto found = std::find_if(run.keyframes.begin(), run.keyframes.end(),
                                  [&](const RunKeyframe& keyframe) { return keyframe.frame_id == frame_id; });
  return static_cast<int>(found - run.keyframes.begin());
}

std::optional<bool> is_wrong(const KeyframeRun& run, const LoopRecord& record, const RevisitOptions& options) {
  const RunKeyframe& keyframe = run.keyframes[index_of(run, record.keyframe_id)];
  const RunKeyframe& candidate = run.keyframes[index_of(run, record.candidate_id)];
  if (!keyframe.T_truth_camera || !candidate.T_truth_camera) return {};
  const SE3d T = keyframe.T_truth_camera->inverse() * *candidate.T_truth_camera;
  const Sim3d& S = record.S_keyframe_candidate;
  const double off = (keyframe.truth_per_unit * S.translation() - T.translation()).norm();
  const double turned = (S.rotation() * T.rotation().inverse()).log().norm() * 180 / std::numbers::pi;
  return !(off <= options.translation * keyframe.depth + options.relative * T.translation().norm()) ||
         !(turned <= options.rotation_deg);
}

std::vector<Stretch> find_stretches(const KeyframeRun& run, const RevisitOptions& options) {
  const std::vector<int> order = in_time(run);
  std::vector<Stretch> stretches;
  int first = -1, last = -1;  // Of the stretch so far: positions in the order.
  const auto end_stretch = [&] {
    if (first >= 0) add_pieces(run, std::span(order).subspan(first, last - first + 1), options.longest, stretches);
    first = -1;
  };
  for (int i = 0; i < static_cast<int>(order.size()); ++i) {
    if (!best_revisited(run, order[i], options)) continue;
    if (i > last + 1 + options.bridged) end_stretch();
    if (first < 0) first = i;
    last = i;
  }
  end_stretch();
  for (const LoopRecord& record : run.records) {
    if (!record.accepted || is_wrong(run, record, options).value_or(true)) continue;
    for (Stretch& s : stretches) s.closed |= s.first_frame <= record.keyframe_id && record.keyframe_id <= s.last_frame;
  }
  return stretches;
}

}  // namespace ldso
