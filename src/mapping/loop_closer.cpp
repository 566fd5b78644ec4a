#include "mapping/loop_closer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "mapping/feature_builder.h"
#include "mapping/pinhole_projection.h"

namespace ldso {
namespace {

/// Share of the windows' information that each of the edges to several keyframes of the window carries: an edge for
/// every pair counts what it knows more than once.
double edge_share(std::size_t edges) { return 2.0 / (static_cast<double>(edges + 1)); }

Matrix7d inverse_of(const Matrix7d& covariance) { return covariance.ldlt().solve(Matrix7d::Identity()); }

LoopRecord make_record(const KeyframeMap& map, int index, const LoopCandidate& candidate, const LoopVerification& v) {
  LoopRecord record;
  record.keyframe_id = map[index].frame_id;
  record.candidate_id = map[candidate.index].frame_id;
  record.reason = v.reason;
  record.score = candidate.score;
  record.descriptor_matches = v.num_descriptor_matches;
  record.pnp_inliers = v.num_pnp_inliers;
  record.points_in_view = v.num_visible;
  record.points_seen = v.num_seen;
  record.inliers = v.sim3.num_inliers;
  record.depth_inliers = v.sim3.num_depth_inliers;
  record.covered_cells = v.covered_cells;
  record.S_keyframe_candidate = v.sim3.S_current_candidate;
  record.translation_stddev = v.uncertainty.translation;
  record.rotation_stddev = v.uncertainty.rotation_rad;
  record.log_scale_stddev = v.uncertainty.log_scale;
  return record;
}

}  // namespace

LoopCloser::LoopCloser(std::shared_ptr<const Vocabulary> vocabulary, const LoopCloserSettings& settings)
    : vocabulary_(std::move(vocabulary)),
      settings_(settings),
      detector_(vocabulary_->word_count(), settings.detection),
      graph_(settings.graph) {}

void LoopCloser::add(const KeyframeUpdate& update, std::span<const Eigen::Vector2f> corners, const Image<Texel>& image,
                     const PinholeIntrinsics& camera) {
  const StageTimer timer(times_, "loops");
  KeyframeFeatures built;
  {
    const StageTimer stage(times_, "loops/describe");
    built = build_features(image, corners, update.points, *vocabulary_);
  }
  const int index = map_.add(update, std::move(built.features));
  connect(index);
  std::vector<LoopCandidate> candidates;
  {
    const StageTimer stage(times_, "loops/query");
    candidates = detector_.detect(map_, built.words);
  }
  const StageTimer stage(times_, "loops/verify");
  for (const LoopCandidate& candidate : candidates) verify(index, candidate, camera);
}

void LoopCloser::connect(int index) {
  graph_.add_keyframe(index, Sim3d(map_[index].T_world_camera));
  const std::vector<Neighbour>& neighbours = map_[index].neighbours;
  for (const Neighbour& neighbour : neighbours) {
    graph_.add_odometry_edge({index, neighbour.index, Sim3d(neighbour.T_this_other),
                              edge_share(neighbours.size()) * inverse_of(neighbour.covariance)});
  }
}

void LoopCloser::verify(int index, const LoopCandidate& candidate, const PinholeIntrinsics& camera) {
  const LoopVerification v = verify_loop(map_, index, candidate.index, camera, settings_.verification);
  records_.push_back(make_record(map_, index, candidate, v));
  if (!v.accepted) return;
  LoopRecord& record = records_.back();
  for (const LoopMatch& match : v.matches) {
    if (!match.inlier) continue;
    const Feature& f = map_[index].features[match.current].feature;
    const Feature& g = map_[match.keyframe].features[match.feature].feature;
    record.matches.push_back({g.u, g.v, f.u, f.v});
  }
  Hypothesis hypothesis{
      index, candidate.index, v.sim3.S_current_candidate, inverse_of(v.sim3.information), records_.size() - 1, false};
  decide(std::move(hypothesis));
}

std::string LoopCloser::contradiction(const Hypothesis& hypothesis, const LoopDiscrepancy& d) const {
  const double unit = 1 / std::max(map_[hypothesis.current].median_idepth, 1e-9);
  const Sim3d error = Sim3d::exp(d.x);
  const Eigen::Vector3d moved =
      hypothesis.S_current_candidate.translation() - (error.inverse() * hypothesis.S_current_candidate).translation();
  char text[160];
  const double far = moved.norm(), most = settings_.max_drift * d.length + unit;
  if (far > most) {
    std::snprintf(text, sizeof(text), "the odometry cannot be off by so much: %.3g (at most %.3g)", far, most);
    return text;
  }
  const double angle = d.x.segment<3>(3).norm() * 180 / std::numbers::pi;
  if (angle > settings_.max_drift_deg) {
    std::snprintf(text, sizeof(text), "the odometry cannot be turned by so much: %.3g deg", angle);
    return text;
  }
  if (std::abs(d.x[6]) > settings_.max_drift_log_scale) {
    std::snprintf(text, sizeof(text), "the odometry's scale cannot be off by so much: %.3g", std::exp(d.x[6]));
    return text;
  }
  return {};
}

bool LoopCloser::confirms(const Hypothesis& older, const Hypothesis& newer) const {
  const std::vector<int> around = map_.covisible(newer.candidate, 3);
  if (!std::binary_search(around.begin(), around.end(), older.candidate)) return false;
  const OdometryChain to_older = map_.chain(newer.current, older.current);
  const OdometryChain to_newer = map_.chain(older.candidate, newer.candidate);
  const Sim3d predicted = to_older.S_from_to * older.S_current_candidate * to_newer.S_from_to;
  const Matrix7d A = to_older.S_from_to.adjoint(), B = (to_older.S_from_to * older.S_current_candidate).adjoint();
  Matrix7d C = newer.covariance + A * older.covariance * A.transpose();
  for (int k = 0; k < 3; ++k) {
    C += variance_factors_[k] * (to_older.covariance[k] + B * to_newer.covariance[k] * B.transpose());
  }
  const Sim3d::Tangent x = (newer.S_current_candidate * predicted.inverse()).log();
  return x.dot(C.ldlt().solve(x)) < settings_.confirmation_chi2;
}

void LoopCloser::decide(Hypothesis hypothesis) {
  LoopRecord& record = records_[hypothesis.record];
  const LoopDiscrepancy d = discrepancy(hypothesis.S_current_candidate, hypothesis.covariance,
                                        map_.chain(hypothesis.current, hypothesis.candidate));
  record.drift_chi2 = discrepancy_chi2(d, Eigen::Vector3d::Ones());
  record.reason = contradiction(hypothesis, d);
  if (!record.reason.empty()) return;
  bool confirmed = record.inliers >= settings_.strong_inliers;
  for (Hypothesis& older : hypotheses_) {
    if (older.current + settings_.confirmation_gap < hypothesis.current) continue;
    if (older.current == hypothesis.current || !confirms(older, hypothesis)) continue;
    confirmed = true;
    if (!older.accepted) accept(older);
  }
  record.reason = "no second keyframe shows the same";
  if (confirmed) accept(hypothesis);
  hypotheses_.push_back(std::move(hypothesis));
}

void LoopCloser::accept(Hypothesis& hypothesis) {
  hypothesis.accepted = true;
  records_[hypothesis.record].accepted = true;
  records_[hypothesis.record].reason.clear();
  discrepancies_.push_back(discrepancy(hypothesis.S_current_candidate, hypothesis.covariance,
                                       map_.chain(hypothesis.current, hypothesis.candidate)));
  graph_.add_loop_edge(
      {hypothesis.current, hypothesis.candidate, hypothesis.S_current_candidate, inverse_of(hypothesis.covariance)});
  record_of_loop_.push_back(hypothesis.record);
}

void LoopCloser::finish() {
  if (!discrepancies_.empty()) optimize();
}

void LoopCloser::optimize() {
  const StageTimer timer(times_, "loops/optimize");
  variance_factors_ = estimate_variance_factors(discrepancies_);
  graph_.set_odometry_variance_factors(variance_factors_);
  graph_.optimize(map_.size() - 1);
  for (std::size_t i = 0; i < record_of_loop_.size(); ++i) {
    records_[record_of_loop_[i]].graph_weight = graph_.loops()[i].weight;
  }
}

std::vector<CorrectedPose> LoopCloser::poses() const {
  std::vector<CorrectedPose> poses;
  for (int i = 0; i < map_.size(); ++i) poses.push_back({map_[i].frame_id, graph_.S_world_keyframe(i)});
  return poses;
}

}  // namespace ldso
