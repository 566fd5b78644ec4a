#pragma once

// The conductor of loop closing: keyframes that left the window in, corrected keyframe poses out. Describes, asks for
// places seen before, verifies them, and lets the pose graph distribute what they say.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/records.h"
#include "ldso/sim3.h"
#include "mapping/graph/drift_model.h"
#include "mapping/graph/pose_graph.h"
#include "mapping/map/feature_builder.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/matching/loop_detector.h"
#include "mapping/matching/loop_predictor.h"
#include "mapping/verification/loop_sharpener.h"
#include "mapping/verification/loop_verifier.h"
#include "place/vocabulary.h"
#include "util/stopwatch.h"

namespace ldso {

class LoopCloser {
 public:
  explicit LoopCloser(std::shared_ptr<const Vocabulary> vocabulary, const LoopSettings& settings = {});

  /// A keyframe that left the window, in the order in which they do, with its image and the camera as estimated then.
  void add(const KeyframeUpdate& update, std::span<const Eigen::Vector2f> corners, const Image<Texel>& image,
           const PinholeIntrinsics& camera);

  /// The same with features that were built before. Without an image loops stay as sharp as their corners.
  void add(const KeyframeUpdate& update, KeyframeFeatures features, const PinholeIntrinsics& camera,
           const CurrentImage* current = nullptr);

  /// Takes all loops into account; the last keyframe stays where it is.
  void finish();

  /// From the odometry's world to the corrected one, at the newest keyframe.
  Sim3d correction() const;

  /// What is kept for each keyframe, on average.
  double bytes_per_keyframe() const;

  /// Of all keyframes, in the order in which they were added.
  std::vector<KeyframePose> poses() const;
  /// Of the keyframe that was added last. There must be one.
  KeyframePose newest_pose() const { return {map_[map_.size() - 1].frame_id, corrected_.back()}; }
  /// How often all poses have changed.
  int optimizations() const { return optimizations_; }
  /// Why the newest optimization of the pose graph failed: the poses are those before it, and the loops since wait for
  /// the next one. Empty if it did not.
  const std::string& graph_failure() const { return graph_failure_; }
  const std::vector<LoopRecord>& loops() const { return records_; }
  const StageTimes& times() const { return times_; }
  const KeyframeMap& map() const { return map_; }
  const VarianceFactors& variance_factors() const { return variance_factors_; }

 private:
  /// A keyframe before all others by more than any spacing.
  static constexpr int kLongAgo = -1'000'000'000;

  /// A verified loop.
  struct Hypothesis {
    int current = 0, candidate = 0;
    Sim3d S_current_candidate;
    Matrix7d covariance;
    std::size_t record = 0;
    bool predicted = false;  ///< By the poses, before anything was seen.
    bool accepted = false;
  };
  /// A first corrected pose: that of the keyframe before it, with the odometry's step.
  void place(int index);
  /// Whether the candidate stands as the place of the keyframe, for now or for good.
  /// `expected`: where it should lie; none: anywhere.
  bool verify(int index, const LoopCandidate& candidate, const PinholeIntrinsics& camera, const CurrentImage* current,
              const std::optional<Sim3d>& expected);
  /// The same of the place that should be in view by the poses, if there is one.
  bool verify_predicted(int index, const PinholeIntrinsics& camera, const CurrentImage* current);
  /// Whether one keyframe is enough for it.
  bool is_strong(const Hypothesis& hypothesis, const LoopDiscrepancy& discrepancy) const;
  /// The similarity from grey levels instead of corners, if they agree on one.
  void sharpen(int candidate, const PinholeIntrinsics& camera, const CurrentImage& current,
               LoopVerification& verification) const;
  /// Why drift cannot explain it; empty if it can.
  std::string contradiction(const Hypothesis& hypothesis, const LoopDiscrepancy& discrepancy) const;
  /// Of what two hypotheses say of the newer one's similarity.
  static LoopDiscrepancy difference(const Hypothesis& older, const Hypothesis& newer, const OdometryChain& to_older,
                                    const OdometryChain& to_newer);
  bool confirms(const Hypothesis& older, const Hypothesis& newer) const;
  bool decide(Hypothesis hypothesis);
  void accept(Hypothesis& hypothesis);
  /// Whether the graph is so far from what the newest loops say that it should not wait for more of them.
  bool is_due(int index) const;
  VarianceFactors learn_variances() const;
  PoseGraph build_odometry_graph() const;
  void optimize();

  std::shared_ptr<const Vocabulary> vocabulary_;
  LoopSettings settings_;
  LoopSettings predicted_settings_;  ///< For places that the poses predicted.
  KeyframeMap map_;
  LoopDetector detector_;
  std::vector<Sim3d> corrected_;  ///< Poses of the keyframes.
  std::vector<Hypothesis> hypotheses_;
  std::vector<Hypothesis> accepted_;  ///< In the order of the graph's loops.
  std::vector<LoopRecord> records_;
  VarianceFactors variance_factors_;
  int last_accepted_ = kLongAgo;   ///< Keyframe of the last closed loop.
  int last_optimized_ = kLongAgo;  ///< Newest keyframe when the graph was optimized last, whether it worked or not.
  int optimizations_ = 0;
  std::string graph_failure_;
  std::size_t loops_in_graph_ = 0;  ///< Those that the corrected poses take account of.
  StageTimes times_;
};

}  // namespace ldso
