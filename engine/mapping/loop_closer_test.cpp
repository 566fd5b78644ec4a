#include "mapping/loop_closer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "geometry/umeyama.h"
#include "ldso/error.h"
#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

using loop_test::circle_drive;
using loop_test::Drive;

std::shared_ptr<const Vocabulary> vocabulary() {
  static const auto kShared = std::make_shared<const Vocabulary>(loop_test::flat_vocabulary());
  return kShared;
}

/// What the tests depend on.
LoopSettings settings() {
  LoopSettings s;
  s.detection.min_gap = 10;
  s.detection.excluded_hops = 2;
  s.detection.min_score = 0.02;
  s.min_inliers = 20;
  s.min_depth_inliers = 10;
  s.min_covered_cells = 0.2;
  s.max_drift = 0.15;
  s.drift.max_rotation_deg = 30;
  s.drift.max_log_scale = 1.5;
  return s;
}

LoopCloser closed(const Drive& drive) {
  LoopCloser closer(vocabulary(), settings());
  for (int i = 0; i < drive.size(); ++i) closer.add(drive.updates[i], drive.features[i], loop_test::camera());
  closer.finish();
  return closer;
}

int accepted_loops(const LoopCloser& closer) {
  int count = 0;
  for (const LoopRecord& record : closer.loops()) count += record.accepted;
  return count;
}

/// Root mean square distance of the keyframes from where they are, after alignment [m].
double error_of(const Drive& drive, const std::vector<Eigen::Vector3d>& positions) {
  std::vector<Eigen::Vector3d> truth;
  for (const SE3d& T : drive.truth) truth.push_back(T.translation());
  const Sim3d S = umeyama(positions, truth, AlignmentMode::kSim3);
  double sum = 0;
  for (int i = 0; i < drive.size(); ++i) sum += (S * positions[i] - truth[i]).squaredNorm();
  return std::sqrt(sum / drive.size());
}

double error_of_odometry(const Drive& drive) {
  std::vector<Eigen::Vector3d> positions;
  for (const SE3d& T : drive.odometry) positions.push_back(T.translation());
  return error_of(drive, positions);
}

double error_of(const Drive& drive, const LoopCloser& closer) {
  std::vector<Eigen::Vector3d> positions;
  for (const KeyframePose& pose : closer.poses()) positions.push_back(pose.S_world_keyframe.translation());
  return error_of(drive, positions);
}

void expect_poses_of_odometry(const Drive& drive, const LoopCloser& closer) {
  const std::vector<KeyframePose> poses = closer.poses();
  ASSERT_EQ(static_cast<int>(poses.size()), drive.size());
  for (int i = 0; i < drive.size(); ++i) {
    EXPECT_EQ(poses[i].keyframe_id, drive.updates[i].frame_id);
    EXPECT_EQ(poses[i].S_world_keyframe.matrix(), Sim3d(drive.odometry[i]).matrix()) << i;
  }
}

void expect_finite(const Drive& drive, const LoopCloser& closer) {
  const std::vector<KeyframePose> poses = closer.poses();
  ASSERT_EQ(static_cast<int>(poses.size()), drive.size());
  for (const KeyframePose& pose : poses) {
    EXPECT_TRUE(pose.S_world_keyframe.matrix().allFinite()) << pose.keyframe_id;
    EXPECT_GT(pose.S_world_keyframe.scale(), 0) << pose.keyframe_id;
  }
}

TEST(LoopCloserTest, ClosesTheCircle) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Drive drive = circle_drive(52, seed);
    const LoopCloser closer = closed(drive);
    EXPECT_GE(accepted_loops(closer), 3);
    EXPECT_GT(error_of_odometry(drive), 0.4);
    EXPECT_LT(error_of(drive, closer), error_of_odometry(drive) / 4) << seed;
  }
}

TEST(LoopCloserTest, TheScaleThatDriftedComesBack) {
  loop_test::DriftSettings drift;
  drift.yaw = 0;
  drift.log_scale = 0.012;
  const Drive drive = circle_drive(52, 4, drift);
  const LoopCloser closer = closed(drive);
  // A map in one unit: keyframe i, whose unit is as large as unit[i], is scaled down by just that.
  const std::vector<KeyframePose> poses = closer.poses();
  for (int i = 0; i < drive.size(); i += 5) {
    EXPECT_NEAR(poses[i].S_world_keyframe.scale() * drive.unit[i] / drive.unit.back(), 1, 0.06) << i;
  }
  EXPECT_GT(std::abs(drive.unit.back() - 1), 0.4);
}

/// Where the odometry goes on from it.
TEST(LoopCloserTest, TheLastKeyframeStaysWhereItIs) {
  const Drive drive = circle_drive(50, 5);
  LoopCloser closer(vocabulary(), settings());
  for (int i = 0; i < drive.size(); ++i) closer.add(drive.updates[i], drive.features[i], loop_test::camera());
  const std::vector<KeyframePose> before = closer.poses();
  closer.finish();
  const std::vector<KeyframePose> after = closer.poses();
  ASSERT_GT(accepted_loops(closer), 0);
  EXPECT_EQ(before.back().S_world_keyframe.matrix(), after.back().S_world_keyframe.matrix());
  EXPECT_NE(before.front().S_world_keyframe.matrix(), after.front().S_world_keyframe.matrix());
}

TEST(LoopCloserTest, LoopsAreTrue) {
  const Drive drive = circle_drive(56, 6);
  const LoopCloser closer = closed(drive);
  ASSERT_GT(accepted_loops(closer), 0);
  for (const LoopRecord& record : closer.loops()) {
    EXPECT_EQ(record.accepted, record.reason.empty());
    EXPECT_GT(record.keyframe_id, record.candidate_id);
    if (!record.accepted) continue;
    const auto i = static_cast<int>(record.keyframe_id / 10), j = static_cast<int>(record.candidate_id / 10);
    EXPECT_GE(i - j, 10);
    const SE3d T = drive.truth[i].inverse() * drive.truth[j];
    const double scale = drive.unit[i] / drive.unit[j];
    const Sim3d truth(T.rotation(), drive.unit[i] * T.translation(), scale);
    const Sim3d::Tangent x = (truth * record.S_keyframe_candidate.inverse()).log();
    // Standard deviations are those of the worst direction. The candidate's neighbours lie in units of their own.
    constexpr double kDriftOfUnit = 0.025;
    EXPECT_LT(x.head<3>().norm(), 5 * record.translation_stddev);
    EXPECT_LT(x.segment<3>(3).norm(), 5 * record.rotation_stddev);
    EXPECT_LT(std::abs(x[6]), 5 * record.log_scale_stddev + kDriftOfUnit);
    EXPECT_EQ(static_cast<int>(record.matches.size()), record.inliers);
    EXPECT_GT(record.graph_weight, 0.5);
    EXPECT_LE(record.graph_weight, 1);
    EXPECT_GE(record.score, 0);  // None if the poses predicted it.
  }
}

TEST(LoopCloserTest, TheSameTwice) {
  const Drive drive = circle_drive(52, 7);
  const LoopCloser a = closed(drive), b = closed(drive);
  ASSERT_GT(accepted_loops(a), 0);
  const auto poses_a = a.poses(), poses_b = b.poses();
  ASSERT_EQ(poses_a.size(), poses_b.size());
  for (std::size_t i = 0; i < poses_a.size(); ++i) {
    EXPECT_EQ(poses_a[i].S_world_keyframe.matrix(), poses_b[i].S_world_keyframe.matrix());
  }
  ASSERT_EQ(a.loops().size(), b.loops().size());
  for (std::size_t i = 0; i < a.loops().size(); ++i) {
    EXPECT_EQ(a.loops()[i].S_keyframe_candidate.matrix(), b.loops()[i].S_keyframe_candidate.matrix());
    EXPECT_EQ(a.loops()[i].graph_weight, b.loops()[i].graph_weight);
    EXPECT_EQ(a.loops()[i].reason, b.loops()[i].reason);
  }
}

TEST(LoopCloserTest, WithoutALoopNothingMoves) {
  const Drive drive = circle_drive(34, 8);
  const LoopCloser closer = closed(drive);
  EXPECT_EQ(accepted_loops(closer), 0);
  expect_poses_of_odometry(drive, closer);
  EXPECT_EQ(closer.map().size(), 34);
}

TEST(LoopCloserTest, NothingFromNothing) {
  LoopCloser closer(vocabulary(), settings());
  closer.finish();
  EXPECT_TRUE(closer.poses().empty());
  EXPECT_TRUE(closer.loops().empty());
}

TEST(LoopCloserTest, FinishTwiceChangesNothing) {
  const Drive drive = circle_drive(50, 9);
  LoopCloser closer = closed(drive);
  const auto before = closer.poses();
  closer.finish();
  const auto after = closer.poses();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].S_world_keyframe.matrix(), after[i].S_world_keyframe.matrix());
  }
}

/// An odometry without drift needs no correction: what loops add is within their errors.
TEST(LoopCloserTest, WhatIsRightStaysRight) {
  loop_test::DriftSettings none;
  none.yaw = 1e-4;
  none.log_scale = 1e-4;
  none.translation = 1e-3;
  none.rotation = 1e-5;
  const Drive drive = circle_drive(52, 10, none);
  const LoopCloser closer = closed(drive);
  EXPECT_GT(accepted_loops(closer), 0);
  EXPECT_LT(error_of_odometry(drive), 0.05);
  EXPECT_LT(error_of(drive, closer), 0.05);
}

/// Its drift is less than the radius of the search.
Drive exact_drive_that_looks_nowhere_alike(std::uint64_t seed) {
  const loop_test::DriftSettings little{.yaw = 1e-4, .log_scale = 1e-4, .translation = 1e-3, .rotation = 1e-5};
  Drive drive = circle_drive(52, seed, little);
  for (KeyframeFeatures& features : drive.features) features.words.clear();
  return drive;
}

TEST(LoopCloserTest, WhatRecognitionMissesIsFoundWhereThePosesPredictIt) {
  for (const std::uint64_t seed : {21, 22}) {
    const Drive drive = exact_drive_that_looks_nowhere_alike(seed);
    const LoopCloser closer = closed(drive);
    EXPECT_GE(accepted_loops(closer), 2) << seed;
    for (const LoopRecord& record : closer.loops()) {
      EXPECT_EQ(record.score, 0);
      // A lap later: forty keyframes.
      if (!record.accepted) continue;
      EXPECT_NEAR(static_cast<double>(record.keyframe_id - record.candidate_id), 400, 20);
    }
    EXPECT_LT(error_of(drive, closer), 0.05);
  }
}

TEST(LoopCloserTest, NothingIsPredictedIfItIsTurnedOff) {
  const Drive drive = exact_drive_that_looks_nowhere_alike(21);
  LoopSettings s = settings();
  s.prediction.max_way = 0;
  LoopCloser closer(vocabulary(), s);
  for (int i = 0; i < drive.size(); ++i) closer.add(drive.updates[i], drive.features[i], loop_test::camera());
  EXPECT_TRUE(closer.loops().empty());
}

/// One loop, found by its looks, corrects a drift that is too large to predict anything; the next ones follow from it.
TEST(LoopCloserTest, AClosedLoopPredictsTheNextOnes) {
  Drive drive = circle_drive(54, 23);
  const LoopCloser all = closed(drive);
  ASSERT_GT(accepted_loops(all), 2);
  std::int64_t first = 0;
  for (const LoopRecord& record : all.loops()) {
    if (record.accepted && (first == 0 || record.keyframe_id < first)) first = record.keyframe_id;
  }
  for (std::size_t i = first / 10 + 2; i < drive.features.size(); ++i) drive.features[i].words.clear();
  int predicted = 0;
  const LoopCloser closer = closed(drive);
  for (const LoopRecord& record : closer.loops()) predicted += record.accepted && record.score == 0;
  EXPECT_GE(predicted, 1);
}

/// Rooms of the same make at both ends of a corridor: the same descriptors, the same geometry.
Drive two_rooms() {
  const Eigen::Vector3d other(0, 0, 60);
  Drive drive;
  drive.landmarks = loop_test::circle_wall(1500, 11);
  const std::size_t room = drive.landmarks.size();
  for (std::size_t i = 0; i < room; ++i) {
    loop_test::Landmark copy = drive.landmarks[i];
    copy.position += other;
    drive.landmarks.push_back(copy);
  }
  for (int i = 0; i < 15; ++i) drive.truth.push_back(loop_test::circle_pose(i));
  const SE3d out = drive.truth.back(), in(SO3d(), other + loop_test::circle_pose(0).translation());
  const int steps = 25;
  for (int i = 1; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const Eigen::Vector3d position = (1 - share) * out.translation() + share * in.translation();
    const SO3d turn = SO3d::exp(share * (out.rotation().inverse() * in.rotation()).log());
    drive.truth.emplace_back(out.rotation() * turn, position);
  }
  for (int i = 0; i < 15; ++i) drive.truth.push_back(loop_test::circle_pose(i + 0.2, other));
  loop_test::add_odometry(drive, {.yaw = 0.001, .log_scale = 0.001}, 12);
  loop_test::SeeingSettings seeing;
  seeing.farthest = 10;
  loop_test::add_features(drive, 13, seeing);
  for (std::size_t i = 15; i < 15 + static_cast<std::size_t>(steps) - 1; ++i)
    drive.features[i] = {};  // The corridor is dark.
  return drive;
}

TEST(LoopCloserTest, TwoRoomsOfTheSameMakeAreTwo) {
  const Drive drive = two_rooms();
  const LoopCloser closer = closed(drive);
  EXPECT_EQ(accepted_loops(closer), 0);
  int refused_by_odometry = 0;
  for (const LoopRecord& record : closer.loops()) {
    EXPECT_FALSE(record.reason.empty());
    // All that was found is there, but not here.
    if (record.reason.find("odometry") != std::string::npos) ++refused_by_odometry;
  }
  EXPECT_GE(refused_by_odometry, 5);
  expect_poses_of_odometry(drive, closer);
}

/// As above, told by what else can be off: the same drive as a loop that turns or scales the map beyond all drift.
TEST(LoopCloserTest, TheOdometryIsNotTurnedOrScaledAtWill) {
  const Drive drive = circle_drive(50, 14);
  for (const bool by_scale : {false, true}) {
    LoopSettings strict = settings();
    strict.max_drift = 1;
    if (by_scale) {
      strict.drift.max_log_scale = 0.05;
    } else {
      strict.drift.max_rotation_deg = 2;
    }
    LoopCloser closer(vocabulary(), strict);
    for (int i = 0; i < drive.size(); ++i) closer.add(drive.updates[i], drive.features[i], loop_test::camera());
    closer.finish();
    EXPECT_EQ(accepted_loops(closer), 0);
    ASSERT_FALSE(closer.loops().empty());
    bool named = false;
    for (const LoopRecord& r : closer.loops()) {
      named |= r.reason.find("odometry") != std::string::npos &&
               r.reason.find(by_scale ? "scale" : "turned") != std::string::npos;
    }
    EXPECT_TRUE(named);
    expect_poses_of_odometry(drive, closer);
  }
}

TEST(LoopCloserTest, KeyframesWithoutFeatures) {
  Drive drive = circle_drive(52, 15);
  for (int i = 0; i < drive.size(); i += 3) drive.features[i] = {};
  const LoopCloser closer = closed(drive);
  expect_finite(drive, closer);
  EXPECT_GT(accepted_loops(closer), 0);
  for (KeyframeFeatures& features : drive.features) features = {};
  expect_poses_of_odometry(drive, closed(drive));
}

TEST(LoopCloserTest, DepthsThatAreNotNumbers) {
  Drive drive = circle_drive(52, 16);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f};
  int i = 0;
  for (KeyframeFeatures& features : drive.features) {
    for (MapFeature& feature : features.features) {
      if (++i % 5 == 0) feature.idepth = bad[i / 5 % 3];
      if (i % 17 == 0) feature.idepth_stddev = bad[i / 17 % 3];
    }
  }
  const LoopCloser closer = closed(drive);
  expect_finite(drive, closer);
  EXPECT_GT(accepted_loops(closer), 0);
  EXPECT_LT(error_of(drive, closer), error_of_odometry(drive) / 3);
}

TEST(LoopCloserTest, CovariancesThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Matrix7d&)>> damages = {
      [](Matrix7d& C) { C.setZero(); },    [](Matrix7d& C) { C.row(2).setZero(), C.col(2).setZero(); },
      [&](Matrix7d& C) { C(1, 1) = nan; }, [](Matrix7d& C) { C = -C; },
      [](Matrix7d& C) { C *= 1e300; },     [](Matrix7d& C) { C *= 1e-300; },
  };
  for (std::size_t k = 0; k < damages.size(); ++k) {
    for (const int every : {1, 4}) {
      Drive drive = circle_drive(48, 17);
      int i = 0;
      for (KeyframeUpdate& update : drive.updates) {
        if (++i % every != 0) continue;
        for (KeyframeConstraint& constraint : update.constraints) damages[k](constraint.covariance);
      }
      SCOPED_TRACE("damage " + std::to_string(k) + " of every " + std::to_string(every));
      expect_finite(drive, closed(drive));
    }
  }
}

/// The solver gives up if a residual is far beyond all that means something: here of a link, beside the chain, that
/// pretends to know everything and is wrong.
TEST(LoopCloserTest, AnOptimizationThatFailsIsNotDone) {
  Drive drive = circle_drive(52, 1);
  KeyframeConstraint& beside_the_chain = drive.updates[25].constraints.back();
  ASSERT_GT(beside_the_chain.keyframe_id, drive.updates[26].frame_id);
  beside_the_chain.T_this_other.translation()[0] += 0.1;
  beside_the_chain.covariance = 1e-150 * Matrix7d::Identity();
  LoopCloser closer = closed(drive);
  ASSERT_GT(accepted_loops(closer), 0);
  EXPECT_EQ(closer.optimizations(), 0);
  EXPECT_FALSE(closer.graph_failure().empty());
  expect_poses_of_odometry(drive, closer);
  EXPECT_TRUE(closed(circle_drive(52, 1)).graph_failure().empty());
}

TEST(LoopCloserTest, AfterARestart) {
  const Drive drive = circle_drive(56, 18, {}, {20});
  const LoopCloser closer = closed(drive);
  expect_finite(drive, closer);
  for (const LoopRecord& record : closer.loops()) EXPECT_EQ(record.accepted, record.reason.empty());
  // What the restart tore apart and no loop has joined stays as it was.
  if (accepted_loops(closer) == 0) expect_poses_of_odometry(drive, closer);
}

TEST(LoopCloserTest, NoConstraintsAtAll) {
  Drive drive = circle_drive(50, 19);
  for (KeyframeUpdate& update : drive.updates) update.constraints.clear();
  expect_finite(drive, closed(drive));
}

TEST(LoopCloserTest, AFrameIdThatIsThereIsAnError) {
  const Drive drive = circle_drive(3, 20);
  LoopCloser closer(vocabulary(), settings());
  closer.add(drive.updates[0], drive.features[0], loop_test::camera());
  EXPECT_THROW(closer.add(drive.updates[0], drive.features[0], loop_test::camera()), Error);
  closer.add(drive.updates[1], drive.features[1], loop_test::camera());
  EXPECT_EQ(closer.poses().size(), 2u);
}

}  // namespace
}  // namespace ldso
