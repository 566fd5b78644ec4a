#include "mapping/loop_closer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "mapping/map/chain_table.h"
#include "mapping/matching/earlier_visits.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// Share of the windows' information that each of a keyframe's edges carries. Keyframes one to n steps apart are all
/// linked: between two neighbours l of the edges of length l pass, and if the variance grows with the length they
/// together hold a stretch as n (n + 1) / 2 chains of direct links would.
double edge_share(std::ptrdiff_t edges) {
  const auto n = static_cast<double>(edges);
  return 2 / (n * (n + 1));
}

/// What the poses say already needs less confirmation.
LoopSettings for_predicted(LoopSettings settings) {
  settings.min_depth_inliers = std::min(settings.min_depth_inliers, settings.prediction.min_depth_inliers);
  return settings;
}

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
  record.inliers_with_depth = v.num_with_depth;
  record.depth_inliers = v.sim3.num_depth_inliers;
  record.covered_cells = v.covered_cells;
  record.patch_inliers = v.num_patch_inliers;
  record.S_keyframe_candidate = v.sim3.S_current_candidate;
  record.translation_stddev = v.uncertainty.translation;
  record.rotation_stddev = v.uncertainty.rotation_rad;
  record.log_scale_stddev = v.uncertainty.log_scale;
  return record;
}

}  // namespace

LoopCloser::LoopCloser(std::shared_ptr<const Vocabulary> vocabulary, const LoopSettings& settings)
    : vocabulary_(std::move(vocabulary)),
      settings_(settings),
      predicted_settings_(for_predicted(settings)),
      map_(settings.drift),
      detector_(vocabulary_->word_count(), settings) {}

void LoopCloser::add(const KeyframeUpdate& update, std::span<const Eigen::Vector2f> corners, const Image<Texel>& image,
                     const PinholeIntrinsics& camera) {
  KeyframeFeatures features;
  {
    const StageTimer stage(times_, "loops/describe");
    features = build_features(image, corners, update.points, *vocabulary_, settings_.matching);
    take_out_readout(camera, update.readout, features.features);
  }
  const CurrentImage current{image, update.readout};
  add(update, std::move(features), camera, &current);
}

void LoopCloser::add(const KeyframeUpdate& update, KeyframeFeatures features, const PinholeIntrinsics& camera,
                     const CurrentImage* current) {
  const int index = map_.add(update, std::move(features.features));
  place(index);
  std::vector<LoopCandidate> candidates;
  {
    const StageTimer stage(times_, "loops/query");
    candidates = detector_.detect(map_, features.words);
  }
  // Places are seen again for a while: not every keyframe has to say so.
  if (index >= last_accepted_ + settings_.spacing) {
    const StageTimer stage(times_, "loops/verify");
    if (!verify_predicted(index, camera, current)) {
      for (const LoopCandidate& candidate : candidates) {
        if (verify(index, candidate, camera, current, {})) break;
      }
    }
  }
  map_.forget_depthless(index);
  if (is_due(index)) optimize();
  const LoopCullingSettings& culling = settings_.culling;
  const bool is_redundant = culling.visits > 0 && earlier_visits(map_, corrected_, index, camera, settings_.detection,
                                                                 culling.min_share) >= culling.visits;
  if (is_redundant) {
    map_.forget(index);
  } else {
    detector_.add(index, features.words);
  }
}

void LoopCloser::place(int index) {
  const Sim3d odometry(map_[index].T_world_camera);
  const std::optional<int> before = map_.before(index);
  // Not before the graph was optimized: without loops the poses are those of the odometry to the last bit.
  if (!before || loops_in_graph_ == 0) {
    corrected_.push_back(odometry);
    return;
  }
  corrected_.push_back(corrected_[*before] * Sim3d(map_[*before].T_world_camera).inverse() * odometry);
}

bool LoopCloser::verify_predicted(int index, const PinholeIntrinsics& camera, const CurrentImage* current) {
  if (index < last_accepted_ + settings_.prediction.spacing) return false;
  std::optional<KnownLoop> last;
  if (!accepted_.empty()) {
    last = {accepted_.back().current, accepted_.back().candidate, accepted_.back().S_current_candidate};
  }
  // Over a short way the odometry is better than most loops, and they would only cost time.
  constexpr int kGaps = 2;
  const int newest = index - kGaps * settings_.detection.min_gap;
  const std::vector<int> excluded = map_.covisible(index, settings_.detection.excluded_hops);
  const std::optional<KnownLoop> expected =
      predict_loop(map_, corrected_, last, index, excluded, newest, camera, settings_.prediction);
  return expected && verify(index, {expected->candidate, 0, 0}, camera, current, expected->S_current_candidate);
}

bool LoopCloser::verify(int index, const LoopCandidate& candidate, const PinholeIntrinsics& camera,
                        const CurrentImage* current, const std::optional<Sim3d>& expected) {
  const LoopSettings& settings = expected ? predicted_settings_ : settings_;
  LoopVerification v = find_similarity(map_, index, candidate.index, camera, settings, expected);
  if (v.reason.empty()) {
    if (current != nullptr) sharpen(candidate.index, camera, *current, v);
    judge_loop(map_, index, candidate.index, camera, settings, v);
  }
  records_.push_back(make_record(map_, index, candidate, v));
  if (!v.accepted) return false;
  LoopRecord& record = records_.back();
  for (const LoopMatch& match : v.matches) {
    if (!match.inlier) continue;
    const Feature& f = map_[index].features[match.current].feature;
    record.matches.push_back({match.candidate_pixel.x(), match.candidate_pixel.y(), f.u, f.v});
  }
  Hypothesis hypothesis{index, candidate.index, v.sim3.S_current_candidate, inverse_of(v.sim3.information),
                        records_.size() - 1};
  hypothesis.predicted = expected.has_value();
  return decide(std::move(hypothesis));
}

void LoopCloser::sharpen(int candidate, const PinholeIntrinsics& camera, const CurrentImage& current,
                         LoopVerification& verification) const {
  std::optional<SharpLoop> sharp = sharpen_loop(map_, candidate, camera, current, verification, settings_.sharpening);
  if (!sharp || !sim3_uncertainty(sharp->estimate.information)) return;
  verification.sim3.S_current_candidate = sharp->estimate.S_current_candidate;
  verification.sim3.information = sharp->estimate.information;
  verification.num_patch_inliers = sharp->estimate.num_inliers;
  verification.patches = std::move(sharp->patches);
}

std::string LoopCloser::contradiction(const Hypothesis& hypothesis, const LoopDiscrepancy& d) const {
  if (d.breaks > 0) return {};  // Where a segment lies relative to another one is for loops alone to say.
  const double unit = 1 / std::max(map_[hypothesis.current].median_idepth, 1e-9);
  const Sim3d error = Sim3d::exp(d.x);
  const Eigen::Vector3d moved =
      hypothesis.S_current_candidate.translation() - (error.inverse() * hypothesis.S_current_candidate).translation();
  const double far = moved.norm(), most = settings_.max_drift * d.length + unit;
  if (far > most) {
    return format_text("the odometry cannot be off by so much: %.3g (at most %.3g)", far, most);
  }
  const double angle = d.x.segment<3>(3).norm() * 180 / std::numbers::pi;
  if (angle > settings_.drift.max_rotation_deg) {
    return format_text("the odometry cannot be turned by so much: %.3g deg", angle);
  }
  if (std::abs(d.x[6]) > settings_.drift.max_log_scale) {
    return format_text("the odometry's scale cannot be off by so much: %.3g", std::exp(d.x[6]));
  }
  return {};
}

LoopDiscrepancy LoopCloser::difference(const Hypothesis& older, const Hypothesis& newer, const OdometryChain& to_older,
                                       const OdometryChain& to_newer) {
  const Sim3d S = to_older.S_from_to * older.S_current_candidate;
  const Matrix7d A = to_older.S_from_to.adjoint(), B = S.adjoint();
  LoopDiscrepancy d;
  d.x = (newer.S_current_candidate * (S * to_newer.S_from_to).inverse()).log();
  d.loop_covariance = newer.covariance + A * older.covariance * A.transpose();
  for (int k = 0; k < 3; ++k) {
    d.odometry_covariance[k] = to_older.covariance[k] + B * to_newer.covariance[k] * B.transpose();
  }
  d.length = to_older.length + to_newer.length;
  d.breaks = to_older.breaks + to_newer.breaks;
  return d;
}

bool LoopCloser::confirms(const Hypothesis& older, const Hypothesis& newer) const {
  const std::vector<int> around = map_.covisible(newer.candidate, settings_.confirmation.hops);
  if (!std::binary_search(around.begin(), around.end(), older.candidate)) return false;
  const LoopDiscrepancy d =
      difference(older, newer, map_.chain(newer.current, older.current), map_.chain(older.candidate, newer.candidate));
  return d.breaks == 0 && discrepancy_chi2(d, variance_factors_) < settings_.confirmation.chi2;
}

bool LoopCloser::is_strong(const Hypothesis& hypothesis, const LoopDiscrepancy& d) const {
  if (d.breaks > 0) return false;  // Between segments nothing else would contradict a wrong loop.
  const LoopRecord& record = records_[hypothesis.record];
  return record.inliers >= settings_.confirmation.strong_inliers ||
         (hypothesis.predicted && record.patch_inliers >= settings_.confirmation.strong_patches);
}

bool LoopCloser::decide(Hypothesis hypothesis) {
  LoopRecord& record = records_[hypothesis.record];
  const LoopDiscrepancy d = discrepancy(hypothesis.S_current_candidate, hypothesis.covariance,
                                        map_.chain(hypothesis.current, hypothesis.candidate));
  record.drift_chi2 = discrepancy_chi2(d, {});
  record.reason = contradiction(hypothesis, d);
  if (!record.reason.empty()) return false;
  bool confirmed = is_strong(hypothesis, d);
  for (Hypothesis& older : hypotheses_) {
    if (older.current + settings_.confirmation.gap < hypothesis.current) continue;
    if (older.current == hypothesis.current || !confirms(older, hypothesis)) continue;
    confirmed = true;
    if (!older.accepted) accept(older);
  }
  record.reason = "no second keyframe shows the same";
  if (confirmed) accept(hypothesis);
  hypotheses_.push_back(std::move(hypothesis));
  return true;
}

void LoopCloser::accept(Hypothesis& hypothesis) {
  hypothesis.accepted = true;
  last_accepted_ = hypothesis.current;
  records_[hypothesis.record].accepted = true;
  records_[hypothesis.record].reason.clear();
  accepted_.push_back(hypothesis);
}

bool LoopCloser::is_due(int index) const {
  const int spacing = std::max(settings_.graph.spacing, map_.size() / settings_.graph.spacing_divisor);
  if (index < last_optimized_ + spacing) return false;
  for (std::size_t i = loops_in_graph_; i < accepted_.size(); ++i) {
    const Hypothesis& loop = accepted_[i];
    const Sim3d S_graph = corrected_[loop.current].inverse() * corrected_[loop.candidate];
    const Sim3d::Tangent x = (loop.S_current_candidate * S_graph.inverse()).log();
    const Matrix7d C = variance_factors_.loops * loop.covariance;
    if (!(x.dot(C.ldlt().solve(x)) < settings_.graph.chi2)) return true;
  }
  return false;
}

void LoopCloser::finish() {
  if (loops_in_graph_ < accepted_.size()) optimize();
}

VarianceFactors LoopCloser::learn_variances() const {
  const ChainTable chains(map_);
  std::vector<LoopDiscrepancy> with_odometry, between;
  for (std::size_t i = 0; i < accepted_.size(); ++i) {
    const Hypothesis& loop = accepted_[i];
    const LoopDiscrepancy of_loop =
        discrepancy(loop.S_current_candidate, loop.covariance, chains.between(loop.current, loop.candidate));
    if (of_loop.breaks == 0) with_odometry.push_back(of_loop);
    if (i == 0) continue;
    const Hypothesis& last = accepted_[i - 1];
    const LoopDiscrepancy of_pair = difference(last, loop, chains.between(loop.current, last.current),
                                               chains.between(last.candidate, loop.candidate));
    if (of_pair.breaks == 0) between.push_back(of_pair);
  }
  return estimate_variance_factors(with_odometry, between, settings_.drift);
}

PoseGraph LoopCloser::build_odometry_graph() const {
  PoseGraph graph(settings_.graph);
  graph.set_odometry_variance_factors(variance_factors_.odometry);
  for (int i = 0; i < map_.size(); ++i) {
    graph.add_keyframe(i, corrected_[i]);
    const std::vector<Neighbour>& neighbours = map_[i].neighbours;
    const auto earlier =
        std::count_if(neighbours.begin(), neighbours.end(), [&](const auto& n) { return n.index < i; });
    for (const Neighbour& neighbour : neighbours) {
      if (neighbour.index > i) continue;
      graph.add_odometry_edge(
          {i, neighbour.index, Sim3d(neighbour.T_this_other), edge_share(earlier) * inverse_of(neighbour.covariance)});
    }
  }
  return graph;
}

void LoopCloser::optimize() {
  const StageTimer timer(times_, "loops/optimize");
  variance_factors_ = learn_variances();
  PoseGraph graph = build_odometry_graph();
  std::vector<std::size_t> record_of_loop;
  for (const Hypothesis& loop : accepted_) {
    const Matrix7d information = inverse_of(variance_factors_.loops * loop.covariance);
    const bool usable = graph.add_loop_edge({loop.current, loop.candidate, loop.S_current_candidate, information});
    if (usable) record_of_loop.push_back(loop.record);
  }
  last_optimized_ = map_.size() - 1;
  const PoseGraphReport report = graph.optimize(last_optimized_);
  graph_failure_ = report.ok ? std::string() : report.reason;
  if (!report.ok) return;
  ++optimizations_;
  loops_in_graph_ = accepted_.size();
  for (std::size_t i = 0; i < record_of_loop.size(); ++i) {
    records_[record_of_loop[i]].graph_weight = graph.loops()[i].weight;
  }
  for (int i = 0; i < map_.size(); ++i) corrected_[i] = graph.S_world_keyframe(i);
}

Sim3d LoopCloser::correction() const {
  if (map_.size() == 0) return Sim3d();
  const int newest = map_.newest();
  return corrected_[newest] * Sim3d(map_[newest].T_world_camera).inverse();
}

double LoopCloser::bytes_per_keyframe() const {
  if (map_.size() == 0) return 0;
  auto bytes = static_cast<double>(detector_.memory_bytes() + corrected_.size() * sizeof(Sim3d));
  for (int i = 0; i < map_.size(); ++i) bytes += static_cast<double>(map_.memory_bytes(i));
  return bytes / map_.size();
}

std::vector<KeyframePose> LoopCloser::poses() const {
  std::vector<KeyframePose> poses;
  for (int i = 0; i < map_.size(); ++i) poses.push_back({map_[i].frame_id, corrected_[i]});
  return poses;
}

}  // namespace ldso
