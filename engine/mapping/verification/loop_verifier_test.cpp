#include "mapping/verification/loop_verifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

using loop_test::Landmark;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What the tests depend on.
LoopSettings settings() {
  LoopSettings s;
  s.verification.min_matches = 15;
  s.pnp.min_inliers = 10;
  s.min_inliers = 20;
  s.min_depth_inliers = 10;
  s.min_covered_cells = 0.2;
  s.verification.min_minor_stddev = 0.04;
  s.min_seen_share = 0.25;
  s.verification.max_rotation_deg = 1;
  s.verification.max_log_scale = 0.05;
  s.verification.max_translation = 0.05;
  s.verification.corner_stddev = 1;
  return s;
}

/// Keyframes 0..3 shared a window; keyframe 4 comes back to them after a while, in another unit.
struct Scene {
  std::vector<Landmark> landmarks = loop_test::box_of_landmarks(250, {-4, -3, 4}, {4, 3, 9}, 1);
  std::vector<SE3d> T_world_camera = {
      SE3d(SO3d(), {-0.3, 0, 0}),
      SE3d(SO3d(), {0, 0.1, 0}),
      SE3d(SO3d::exp({0, 0.03, 0}), {0.3, 0, 0}),
      SE3d(SO3d::exp({0.02, 0, 0}), {0.6, 0, 0.2}),
      SE3d(SO3d::exp({0.03, -0.12, 0.05}), {0.9, -0.2, 0.4}),
  };
  double current_unit = 1.3;
  std::vector<std::vector<MapFeature>> features;

  static constexpr int kCandidate = 1, kCurrent = 4;

  explicit Scene(std::uint64_t seed = 1, const loop_test::SeeingSettings& seeing = {}) { look(seed, seeing); }

  void look(std::uint64_t seed, const loop_test::SeeingSettings& seeing = {}) {
    features.clear();
    for (int i = 0; i < 5; ++i) {
      const double unit = i == kCurrent ? current_unit : 1;
      features.push_back(loop_test::see(landmarks, T_world_camera[i], unit, 10 * seed + i, seeing).features);
    }
  }

  Sim3d truth() const {
    const SE3d T = T_world_camera[kCurrent].inverse() * T_world_camera[kCandidate];
    return Sim3d(T.rotation(), current_unit * T.translation(), current_unit);
  }

  KeyframeMap map() const {
    KeyframeMap map;
    for (int i = 0; i < 5; ++i) {
      KeyframeUpdate update;
      update.frame_id = i;
      for (int j = i + 1; j < kCurrent; ++j) {
        update.constraints.push_back(
            {j, T_world_camera[i].inverse() * T_world_camera[j], loop_test::diagonal_covariance(0.01, 0.001, 0.001)});
      }
      map.add(update, features[i]);
    }
    return map;
  }

  LoopVerification verify() const { return verify_loop(map(), kCurrent, kCandidate, loop_test::camera(), settings()); }

  double chi2(const LoopVerification& v) const {
    const Sim3d::Tangent x = (truth() * v.sim3.S_current_candidate.inverse()).log();
    return x.dot(v.sim3.information * x);
  }

  void for_all(const std::function<void(MapFeature&)>& change) {
    for (auto& of_keyframe : features) {
      for (MapFeature& feature : of_keyframe) change(feature);
    }
  }
};

void expect_finite(const LoopVerification& v) {
  EXPECT_TRUE(v.sim3.S_current_candidate.matrix().allFinite());
  if (!v.accepted) return;
  EXPECT_TRUE(v.sim3.information.allFinite());
  EXPECT_TRUE(std::isfinite(v.uncertainty.translation) && std::isfinite(v.uncertainty.rotation_rad));
}

void expect_refused(const LoopVerification& v, const std::string& word = {}) {
  EXPECT_FALSE(v.accepted);
  EXPECT_FALSE(v.reason.empty());
  EXPECT_NE(v.reason.find(word), std::string::npos) << v.reason;
  expect_finite(v);
}

TEST(LoopVerifierTest, FindsTheSimilarityWithinItsUncertainty) {
  double sum = 0;
  constexpr int kRuns = 10;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Scene scene(seed);
    const LoopVerification v = scene.verify();
    ASSERT_TRUE(v.accepted) << v.reason;
    EXPECT_TRUE(v.reason.empty());
    expect_finite(v);
    const double chi2 = scene.chi2(v);
    EXPECT_LT(chi2, 35) << seed;  // 1 of 100,000 with seven degrees of freedom.
    sum += chi2;
    EXPECT_NEAR(v.sim3.S_current_candidate.scale(), 1.3, 0.05);
    const Eigen::Vector3d off = v.sim3.S_current_candidate.translation() - scene.truth().translation();
    EXPECT_LT(off.norm(), 0.1);
  }
  EXPECT_LT(sum / kRuns, 14);
}

TEST(LoopVerifierTest, SaysWhatItFound) {
  const Scene scene;
  const LoopVerification v = scene.verify();
  ASSERT_TRUE(v.accepted) << v.reason;
  EXPECT_GT(v.num_descriptor_matches, 60);
  EXPECT_GT(v.num_pnp_inliers, v.num_descriptor_matches / 2);
  EXPECT_LE(v.num_pnp_inliers, v.num_descriptor_matches);
  EXPECT_GT(v.num_seen, v.num_visible / 2);
  EXPECT_LE(v.num_seen, v.num_visible);
  EXPECT_GT(v.covered_cells, 0.5);
  int inliers = 0;
  for (const LoopMatch& match : v.matches) {
    if (!match.inlier) continue;
    ++inliers;
    // The same landmark: descriptors that differ by what was flipped in both.
    const MapFeature& a = scene.features[match.keyframe][match.feature];
    const MapFeature& b = scene.features[Scene::kCurrent][match.current];
    EXPECT_LE(hamming_distance(a.feature.descriptor, b.feature.descriptor), 20);
    EXPECT_TRUE(match.candidate_pixel.allFinite());
    if (match.keyframe != Scene::kCandidate) continue;
    EXPECT_LT((match.candidate_pixel - Eigen::Vector2f(a.feature.u, a.feature.v)).norm(), 1e-2);
  }
  EXPECT_EQ(inliers, v.sim3.num_inliers);
  EXPECT_GT(inliers, 60);
}

TEST(LoopVerifierTest, NeighboursOfTheCandidateHelp) {
  const Scene scene;
  const LoopVerification together = scene.verify();
  KeyframeMap alone;
  for (int i : {Scene::kCandidate, Scene::kCurrent}) {
    KeyframeUpdate update;
    update.frame_id = i;
    alone.add(update, scene.features[i]);
  }
  const LoopVerification single = verify_loop(alone, 1, 0, loop_test::camera(), settings());
  ASSERT_TRUE(single.accepted) << single.reason;
  EXPECT_LT(scene.chi2(single), 35);
  EXPECT_GT(together.sim3.num_inliers, single.sim3.num_inliers);
}

TEST(LoopVerifierTest, SurvivesWrongMatches) {
  Scene scene;
  // A third of the current keyframe's corners look like another corner of the candidate's.
  auto& seen = scene.features[Scene::kCurrent];
  const auto& there = scene.features[Scene::kCandidate];
  for (std::size_t i = 0; i < seen.size(); i += 3) {
    seen[i].feature.descriptor = there[(7 * i) % there.size()].feature.descriptor;
    seen[i].node = there[(7 * i) % there.size()].node;
  }
  const LoopVerification v = scene.verify();
  ASSERT_TRUE(v.accepted) << v.reason;
  EXPECT_LT(scene.chi2(v), 35);
}

TEST(LoopVerifierTest, TooFewMatches) {
  Scene scene;
  scene.features[Scene::kCurrent].resize(12);
  const LoopVerification v = scene.verify();
  expect_refused(v, "matches");
  EXPECT_LT(v.num_descriptor_matches, 15);
}

TEST(LoopVerifierTest, OtherDescriptors) {
  Scene scene;
  std::mt19937_64 random(9);
  for (MapFeature& feature : scene.features[Scene::kCurrent]) {
    feature.feature.descriptor = place_test::random_descriptor(random);
  }
  expect_refused(scene.verify(), "matches");
}

TEST(LoopVerifierTest, SameCornersElsewhere) {
  // Things that are everywhere: alike one by one, but not where they lie to each other.
  Scene scene;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<float> u(0, 639), v(0, 479);
  for (MapFeature& feature : scene.features[Scene::kCurrent]) {
    feature.feature.u = u(random);
    feature.feature.v = v(random);
  }
  const LoopVerification result = scene.verify();
  expect_refused(result);
  EXPECT_GT(result.num_descriptor_matches, 60);
}

TEST(LoopVerifierTest, NoDepthInTheCurrentKeyframe) {
  Scene scene;
  for (MapFeature& feature : scene.features[Scene::kCurrent]) feature.idepth = feature.idepth_stddev = 0;
  expect_refused(scene.verify(), "depth");
}

TEST(LoopVerifierTest, TooFewDepthsInTheCurrentKeyframe) {
  Scene scene;
  auto& seen = scene.features[Scene::kCurrent];
  for (std::size_t i = 8; i < seen.size(); ++i) seen[i].idepth = 0;
  expect_refused(scene.verify(), "depth");
}

TEST(LoopVerifierTest, NoDepthInTheCandidate) {
  Scene scene;
  for (MapFeature& feature : scene.features[Scene::kCandidate]) feature.idepth = 0;
  // Its neighbours know enough; without them nothing is left.
  const LoopVerification v = scene.verify();
  expect_finite(v);
  if (v.accepted) {
    EXPECT_LT(scene.chi2(v), 35);
  }
  for (int i = 0; i < Scene::kCurrent; ++i) {
    for (MapFeature& feature : scene.features[i]) feature.idepth = 0;
  }
  expect_refused(scene.verify());
}

TEST(LoopVerifierTest, AllInOneCornerOfTheImage) {
  Scene scene;
  // All that is left in the current image lies in a patch of 90 x 90 pixels, and there is plenty of it.
  const PinholeIntrinsics camera = loop_test::camera();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(20, 110), v(20, 110), depth(4, 8);
  scene.landmarks.clear();
  for (int i = 0; i < 150; ++i) {
    const Eigen::Vector3d p = depth(random) * viewing_ray(camera, {u(random), v(random)});
    loop_test::add_landmark(scene.landmarks, scene.T_world_camera[Scene::kCurrent] * p, random);
  }
  scene.look(1);
  const LoopVerification result = scene.verify();
  EXPECT_GT(result.num_descriptor_matches, 30);
  expect_refused(result);
  EXPECT_LT(result.covered_cells, 0.2);
}

TEST(LoopVerifierTest, AllOnALine) {
  Scene scene;
  std::mt19937_64 random(3);
  scene.landmarks.clear();
  for (int i = 0; i < 150; ++i) loop_test::add_landmark(scene.landmarks, {-4 + i * 8.0 / 150, 0.3, 6}, random);
  scene.look(1);
  const LoopVerification result = scene.verify();
  EXPECT_GT(result.num_descriptor_matches, 30);
  expect_refused(result);
}

/// What is far away says where the camera looks, but hardly where it is.
TEST(LoopVerifierTest, OnAPlaneFarAwayItClaimsNoMoreThanItKnows) {
  Scene scene;
  scene.landmarks = loop_test::box_of_landmarks(250, {-150, -110, 199}, {150, 110, 199.5}, 5);
  for (int seed = 1; seed <= 5; ++seed) {
    scene.look(seed);
    const LoopVerification v = scene.verify();
    expect_finite(v);
    EXPECT_EQ(v.accepted, v.reason.empty());
    if (!v.accepted) continue;
    EXPECT_LT(scene.chi2(v), 35);
    EXPECT_GT(v.uncertainty.translation, 0.05);
  }
}

TEST(LoopVerifierTest, AFewDepthsThatAreNotNumbers) {
  Scene scene;
  int i = 0;
  scene.for_all([&](MapFeature& feature) {
    const float bad[] = {kNaN, kInfinity, -kInfinity, -1.0f};
    if (++i % 7 == 0) feature.idepth = bad[i / 7 % 4];
    if (i % 11 == 0) feature.idepth_stddev = bad[i / 11 % 4];
  });
  const LoopVerification v = scene.verify();
  ASSERT_TRUE(v.accepted) << v.reason;
  expect_finite(v);
  EXPECT_LT(scene.chi2(v), 35);
}

TEST(LoopVerifierTest, NoDepthIsANumber) {
  for (const float bad : {kNaN, kInfinity, -1.0f}) {
    Scene scene;
    scene.for_all([&](MapFeature& feature) { feature.idepth = bad; });
    expect_refused(scene.verify());
  }
  for (const float bad : {kNaN, kInfinity, -1.0f, 0.0f}) {
    Scene scene;
    scene.for_all([&](MapFeature& feature) { feature.idepth_stddev = bad; });
    expect_finite(scene.verify());
  }
}

TEST(LoopVerifierTest, PixelsThatAreNotNumbers) {
  Scene scene;
  int i = 0;
  scene.for_all([&](MapFeature& feature) {
    if (++i % 9 == 0) feature.feature.u = kNaN;
    if (i % 13 == 0) feature.feature.angle = kNaN;
  });
  const LoopVerification v = scene.verify();
  expect_finite(v);
  if (v.accepted) {
    EXPECT_LT(scene.chi2(v), 35);
  }
  scene.for_all([&](MapFeature& feature) { feature.feature.v = kInfinity; });
  expect_refused(scene.verify());
}

TEST(LoopVerifierTest, EmptyKeyframes) {
  for (const int empty : {Scene::kCurrent, Scene::kCandidate}) {
    Scene scene;
    scene.features[empty].clear();
    const LoopVerification v = scene.verify();
    expect_finite(v);
    if (empty == Scene::kCurrent) expect_refused(v, "matches");
  }
  Scene scene;
  for (auto& features : scene.features) features.clear();
  expect_refused(scene.verify(), "matches");
}

TEST(LoopVerifierTest, ConstraintsThatAreNotNumbers) {
  const Scene scene;
  KeyframeMap map;
  for (int i = 0; i < 5; ++i) {
    KeyframeUpdate update;
    update.frame_id = i;
    SE3d bad;
    bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
    if (i < 3) update.constraints.push_back({i + 1, bad, Matrix7d::Identity()});
    map.add(update, scene.features[i]);
  }
  const LoopVerification v = verify_loop(map, 4, 1, loop_test::camera(), settings());
  expect_finite(v);
  if (v.accepted) {
    EXPECT_LT(scene.chi2(v), 35);
  }
}

/// A pattern that repeats: over the whole image nothing is unambiguous, around an expectation it is.
TEST(LoopVerifierTest, WhatLooksTheSameIsToldByWhereItIsExpected) {
  constexpr int kLooks = 8;
  std::mt19937_64 random(3);
  std::vector<OrbDescriptor> looks;
  for (int i = 0; i < kLooks; ++i) looks.push_back(place_test::random_descriptor(random));
  Scene scene;
  for (std::size_t i = 0; i < scene.landmarks.size(); ++i) scene.landmarks[i].descriptor = looks[i % kLooks];
  scene.look(1);
  expect_refused(scene.verify(), "matches");
  Sim3d::Tangent x = Sim3d::Tangent::Zero();
  x[4] = 0.01;  // 4 px
  LoopSettings s = settings();
  s.prediction.radius = 12;
  const LoopVerification v = verify_loop(scene.map(), Scene::kCurrent, Scene::kCandidate, loop_test::camera(), s,
                                         Sim3d::exp(x) * scene.truth());
  ASSERT_TRUE(v.accepted) << v.reason;
  EXPECT_LT(scene.chi2(v), 35);
}

TEST(LoopVerifierTest, NothingIsFoundWhereTheExpectationIsFarOff) {
  const Scene scene;
  Sim3d::Tangent x = Sim3d::Tangent::Zero();
  x[4] = 0.3;  // 120 px
  expect_refused(verify_loop(scene.map(), Scene::kCurrent, Scene::kCandidate, loop_test::camera(), settings(),
                             Sim3d::exp(x) * scene.truth()));
}

TEST(LoopVerifierTest, PatchesCountAsSeen) {
  const Scene scene;
  LoopVerification v =
      find_similarity(scene.map(), Scene::kCurrent, Scene::kCandidate, loop_test::camera(), settings());
  ASSERT_TRUE(v.reason.empty()) << v.reason;
  for (LoopMatch& match : v.matches) match.inlier = false;
  const LoopVerification found = v;
  judge_loop(scene.map(), Scene::kCurrent, Scene::kCandidate, loop_test::camera(), settings(), v);
  expect_refused(v, "share of the image");
  v = found;
  for (const LoopMatch& match : v.matches)
    v.patches.push_back({match.keyframe, match.feature, match.pixel.cast<double>()});
  judge_loop(scene.map(), Scene::kCurrent, Scene::kCandidate, loop_test::camera(), settings(), v);
  EXPECT_TRUE(v.accepted) << v.reason;
}

TEST(LoopVerifierTest, TheSameTwice) {
  const Scene scene;
  const LoopVerification a = scene.verify(), b = scene.verify();
  EXPECT_EQ(a.accepted, b.accepted);
  EXPECT_EQ(a.sim3.S_current_candidate.matrix(), b.sim3.S_current_candidate.matrix());
  EXPECT_EQ(a.sim3.information, b.sim3.information);
  ASSERT_EQ(a.matches.size(), b.matches.size());
  for (std::size_t i = 0; i < a.matches.size(); ++i) {
    EXPECT_EQ(a.matches[i].keyframe, b.matches[i].keyframe);
    EXPECT_EQ(a.matches[i].feature, b.matches[i].feature);
    EXPECT_EQ(a.matches[i].current, b.matches[i].current);
    EXPECT_EQ(a.matches[i].inlier, b.matches[i].inlier);
  }
}

TEST(LoopVerifierTest, DepthsThatContradictEachOther) {
  Scene scene;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<float> idepth(0.01f, 2);
  for (MapFeature& feature : scene.features[Scene::kCurrent]) {
    feature.idepth = idepth(random);
    feature.idepth_stddev = 0.01f * feature.idepth;
  }
  expect_refused(scene.verify());
}

}  // namespace
}  // namespace ldso
