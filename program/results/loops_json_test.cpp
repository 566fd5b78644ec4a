#include "results/loops_json.h"

#include <gtest/gtest.h>

#include <limits>

namespace ldso {
namespace {

using Json = nlohmann::ordered_json;

LoopRecord accepted_loop() {
  LoopRecord loop;
  loop.keyframe_id = 912;
  loop.candidate_id = 31;
  loop.accepted = true;
  loop.score = 0.125;
  loop.descriptor_matches = 80;
  loop.pnp_inliers = 60;
  loop.points_in_view = 210;
  loop.points_seen = 150;
  loop.inliers = 140;
  loop.depth_inliers = 90;
  loop.covered_cells = 0.75;
  loop.patch_inliers = 400;
  loop.S_keyframe_candidate = Sim3d(SO3d::exp({0.1, -0.2, 0.3}), {1, -2, 3}, 1.25);
  loop.translation_stddev = 0.01;
  loop.rotation_stddev = 0.002;
  loop.log_scale_stddev = 0.003;
  loop.drift_chi2 = 12.5;
  loop.graph_weight = 0.875;
  loop.matches = {{1, 2, 3, 4}};
  return loop;
}

LoopRecord refused_loop() {
  LoopRecord loop;
  loop.keyframe_id = 400;
  loop.candidate_id = 7;
  loop.reason = "too few matches \"by appearance\": 8";
  loop.score = 0.0625;
  loop.descriptor_matches = 8;
  return loop;
}

TEST(LoopsJson, HoldsEveryFigureOfAnAcceptedLoop) {
  const Json json = loops_json({accepted_loop()});
  ASSERT_EQ(json["accepted"].size(), 1U);
  EXPECT_TRUE(json["refused"].empty());
  const Json& loop = json["accepted"][0];
  const Json expected = Json::parse(R"({"keyframe": 912, "candidate": 31, "accepted": true, "score": 0.125,
      "descriptor_matches": 80, "pnp_inliers": 60, "points_in_view": 210, "points_seen": 150, "inliers": 140,
      "depth_inliers": 90, "covered_cells": 0.75, "patch_inliers": 400,
      "translation_stddev": 0.01, "rotation_stddev_rad": 0.002,
      "log_scale_stddev": 0.003, "drift_chi2": 12.5, "graph_weight": 0.875})");
  for (const auto& [name, value] : expected.items()) {
    ASSERT_TRUE(loop.contains(name)) << name;
    EXPECT_EQ(loop[name], value) << name;
  }
  EXPECT_FALSE(loop.contains("reason"));
  const Json& similarity = loop["S_keyframe_candidate"];
  EXPECT_EQ(similarity["translation"], Json({1.0, -2.0, 3.0}));
  EXPECT_DOUBLE_EQ(similarity["scale"], 1.25);
}

TEST(LoopsJson, TheQuaternionIsInTheOrderXyzw) {
  const LoopRecord loop = accepted_loop();
  // Through the text, as those who read the file get it.
  const Json json = Json::parse(loops_json({loop}).dump());
  const auto q = json["accepted"][0]["S_keyframe_candidate"]["quaternion_xyzw"].get<std::vector<double>>();
  ASSERT_EQ(q.size(), 4U);
  const SO3d rotation(Eigen::Quaterniond(q[3], q[0], q[1], q[2]));
  EXPECT_LT((rotation.inverse() * loop.S_keyframe_candidate.rotation()).log().norm(), 1e-12);
}

TEST(LoopsJson, RefusedOnesSayWhy) {
  const Json json = loops_json({refused_loop(), accepted_loop(), refused_loop()});
  EXPECT_EQ(json["accepted"].size(), 1U);
  ASSERT_EQ(json["refused"].size(), 2U);
  const Json& loop = json["refused"][0];
  EXPECT_EQ(loop["accepted"], false);
  EXPECT_EQ(loop["reason"], refused_loop().reason);
  EXPECT_EQ(loop["keyframe"], 400);
  EXPECT_EQ(loop["candidate"], 7);
  EXPECT_EQ(loop["descriptor_matches"], 8);
  EXPECT_FALSE(loop.contains("S_keyframe_candidate")) << "it got not so far";
  EXPECT_FALSE(loop.contains("graph_weight")) << "the pose graph has not seen it";
}

TEST(LoopsJson, ARefusedSimilarityIsThere) {
  LoopRecord loop = accepted_loop();
  loop.accepted = false;
  loop.reason = "no second keyframe shows the same";
  const Json json = loops_json({loop});
  EXPECT_DOUBLE_EQ(json["refused"][0]["S_keyframe_candidate"]["scale"], 1.25);
}

TEST(LoopsJson, NoLoopsAreEmptyLists) { EXPECT_EQ(loops_json({}).dump(), R"({"accepted":[],"refused":[]})"); }

TEST(LoopsJson, WhatIsNotFiniteIsStillJson) {
  LoopRecord loop = accepted_loop();
  loop.drift_chi2 = std::numeric_limits<double>::infinity();
  loop.translation_stddev = std::numeric_limits<double>::quiet_NaN();
  const Json json = Json::parse(loops_json({loop}).dump());
  EXPECT_TRUE(json["accepted"][0]["drift_chi2"].is_null());
  EXPECT_TRUE(json["accepted"][0]["translation_stddev"].is_null());
}

}  // namespace
}  // namespace ldso
