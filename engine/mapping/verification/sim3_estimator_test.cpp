#include "mapping/verification/sim3_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "mapping/verification/test_sim3_scene.h"

namespace ldso {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;

/// A guess as PnP and the median of the depth ratios give it: some pixels and some percent off.
Sim3d rough_guess(const Sim3d& truth) {
  Vector7d x;
  x << 0.05, -0.04, 0.06, 0.01, -0.012, 0.015, 0.08;
  return Sim3d::exp(x) * truth;
}

Vector7d error_of(const Sim3Estimate& estimate, const Sim3Scene& scene) {
  return (scene.truth * estimate.S_current_candidate.inverse()).log();
}

Sim3Estimate estimate(const Sim3Scene& scene) {
  return estimate_sim3(scene.matches, scene.camera, rough_guess(scene.truth));
}

void expect_finite(const Sim3Estimate& e) {
  EXPECT_TRUE(e.S_current_candidate.matrix().allFinite());
  EXPECT_TRUE(e.information.allFinite());
  EXPECT_TRUE(std::isfinite(e.reprojection_rmse_px) && std::isfinite(e.log_depth_rmse));
  EXPECT_TRUE(std::isfinite(e.pixel_variance_factor) && std::isfinite(e.depth_variance_factor));
}

TEST(Sim3EstimatorTest, ExactWithoutNoise) {
  Sim3SceneSettings exact;
  exact.noise_scale = 0;
  const Sim3Scene scene = make_sim3_scene(1, exact);
  const Sim3Estimate result = estimate(scene);
  ASSERT_EQ(result.status, Sim3Status::kOk);
  EXPECT_LT(error_of(result, scene).norm(), 1e-6);
  EXPECT_EQ(result.num_inliers, 150);
  EXPECT_TRUE(result.scale_determined);
  EXPECT_EQ(result.pixel_variance_factor, 1);
}

TEST(Sim3EstimatorTest, RecoversTheSimilarityAmongOutliers) {
  Sim3SceneSettings settings;
  settings.outlier_share = 0.3;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Sim3Scene scene = make_sim3_scene(seed, settings);
    const Sim3Estimate result = estimate(scene);
    ASSERT_EQ(result.status, Sim3Status::kOk);
    const Vector7d x = error_of(result, scene);
    EXPECT_LT(x.head<3>().norm(), 0.08) << seed;
    EXPECT_LT(x.segment<3>(3).norm(), 0.008) << seed;
    EXPECT_LT(std::abs(x[6]), 0.03) << seed;
    int false_inliers = 0, missed = 0;
    for (std::size_t i = 0; i < scene.is_true.size(); ++i) {
      false_inliers += result.is_inlier[i] && !scene.is_true[i] ? 1 : 0;
      missed += !result.is_inlier[i] && scene.is_true[i] ? 1 : 0;
    }
    EXPECT_LE(false_inliers, 1) << seed;
    EXPECT_LE(missed, 7) << seed;
    EXPECT_NEAR(result.reprojection_rmse_px, 5, 2) << seed;  // the candidates' uncertain depths add to the pixels' 1.4
  }
}

TEST(Sim3EstimatorTest, ErrorsThatGroupsShareWidenTheCovariance) {
  constexpr int kCells = 6, kRuns = 40;
  double independent = 0, shared = 0, blind = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    Sim3SceneSettings settings;
    settings.count = 400;
    settings.relative_depth_sigma = 0.01;
    Sim3Scene scene = make_sim3_scene(seed, settings);
    const auto set_groups = [&](bool known) {
      for (Sim3Correspondence& c : scene.matches) {
        const Eigen::Array2i cell = (c.pixel.array() / Eigen::Array2d(640, 480) * kCells).cast<int>();
        c.group = known ? cell.y() * kCells + cell.x() : -1;
      }
    };
    const auto chi2 = [&] {
      const Sim3Estimate result = estimate(scene);
      EXPECT_EQ(result.status, Sim3Status::kOk);
      const Vector7d x = error_of(result, scene);
      return x.dot(result.information * x) / kRuns;
    };
    set_groups(true);
    independent += chi2();
    std::mt19937_64 random(seed + 1000);
    std::normal_distribution<double> normal(0, 1);
    std::map<int, Eigen::Vector2d> offsets;
    for (Sim3Correspondence& c : scene.matches) {
      if (!offsets.count(c.group)) offsets[c.group] = {normal(random), normal(random)};
    }
    for (Sim3Correspondence& c : scene.matches) c.pixel += offsets[c.group];
    shared += chi2();
    set_groups(false);
    blind += chi2();
  }
  // Seven where the covariance is right.
  EXPECT_LT(independent, 10);
  EXPECT_GT(blind, 20);
  EXPECT_LT(shared, 0.6 * blind);
}

TEST(Sim3EstimatorTest, WrongDepthsLeaveThePixelsInUse) {
  Sim3SceneSettings settings;
  settings.depth_outlier_share = 0.3;
  settings.relative_depth_sigma = 0.02;
  const Sim3Scene scene = make_sim3_scene(4, settings);
  const Sim3Estimate result = estimate(scene);
  ASSERT_EQ(result.status, Sim3Status::kOk);
  EXPECT_LT(std::abs(error_of(result, scene)[6]), 0.01);
  EXPECT_GE(result.num_inliers, 143);
  int wrong = 0, right = 0;
  for (std::size_t i = 0; i < scene.is_true.size(); ++i) {
    if (result.is_depth_inlier[i]) ++(scene.is_true_depth[i] ? right : wrong);
  }
  EXPECT_LE(wrong, 3);
  EXPECT_GE(right, 55);
  EXPECT_EQ(result.num_depth_inliers, right + wrong);
}

/// Mean of x^T H x (the normalized estimation error squared), of x over its standard deviation, and of x^2 likewise.
struct Consistency {
  double mean_nees = 0;
  Vector7d bias = Vector7d::Zero();
  double scale_nees = 0;
};

Consistency consistency(const Sim3SceneSettings& settings, int trials) {
  Consistency result;
  for (int trial = 0; trial < trials; ++trial) {
    const Sim3Scene scene = make_sim3_scene(1000 + trial, settings);
    const Sim3Estimate e = estimate(scene);
    EXPECT_EQ(e.status, Sim3Status::kOk);
    const Vector7d x = error_of(e, scene);
    const Matrix7d covariance = e.information.ldlt().solve(Matrix7d::Identity());
    result.mean_nees += x.dot(e.information * x) / trials;
    result.bias += x.cwiseQuotient(covariance.diagonal().cwiseSqrt()) / trials;
    result.scale_nees += x[6] * x[6] / covariance(6, 6) / trials;
  }
  return result;
}

// The uncertainty is true: over many draws x^T H x is distributed as chi-squared with 7 degrees of freedom, whose
// mean over 200 draws is 7 +- 0.26; a little below is right as the variance is never taken smaller than claimed.
TEST(Sim3EstimatorTest, InformationIsTrue) {
  Sim3SceneSettings settings;
  settings.count = 80;
  const Consistency plain = consistency(settings, 200);
  EXPECT_GT(plain.mean_nees, 6.0);
  EXPECT_LT(plain.mean_nees, 7.7);
  EXPECT_LT(plain.bias.cwiseAbs().maxCoeff(), 0.25) << plain.bias.transpose();
  EXPECT_GT(plain.scale_nees, 0.7);
  EXPECT_LT(plain.scale_nees, 1.25);
  RecordProperty("nees", std::to_string(plain.mean_nees));
}

TEST(Sim3EstimatorTest, InformationIsTrueAmongOutliers) {
  Sim3SceneSettings settings;
  settings.count = 100;
  settings.outlier_share = 0.3;
  settings.depth_outlier_share = 0.1;
  const Consistency result = consistency(settings, 200);
  EXPECT_GT(result.mean_nees, 6.0);
  EXPECT_LT(result.mean_nees, 8.2);
  EXPECT_LT(result.bias.cwiseAbs().maxCoeff(), 0.25) << result.bias.transpose();
  RecordProperty("nees", std::to_string(result.mean_nees));
}

// Noise larger than claimed shows in the residuals, and the information tells it.
TEST(Sim3EstimatorTest, InformationFollowsLargerNoise) {
  Sim3SceneSettings settings;
  settings.count = 80;
  settings.noise_scale = 1.7;
  settings.idepth_noise_scale = 2;
  settings.relative_depth_sigma = 0.03;
  const Consistency result = consistency(settings, 200);
  EXPECT_GT(result.mean_nees, 5.5);
  EXPECT_LT(result.mean_nees, 8.7);
  RecordProperty("nees", std::to_string(result.mean_nees));
  const Sim3Estimate one = estimate(make_sim3_scene(1000, settings));
  EXPECT_GT(one.pixel_variance_factor, 2);
  EXPECT_GT(one.depth_variance_factor, 3);
}

TEST(Sim3EstimatorTest, FewMatchesAreUncertainNotWrong) {
  Sim3SceneSettings settings;
  settings.count = 25;
  settings.outlier_share = 0.2;
  const Consistency result = consistency(settings, 200);
  EXPECT_LT(result.mean_nees, 9);
  RecordProperty("nees", std::to_string(result.mean_nees));
}

TEST(Sim3EstimatorTest, WithoutDepthTheScaleIsUnknown) {
  Sim3SceneSettings settings;
  settings.depth_share = 0;
  const Sim3Scene scene = make_sim3_scene(5, settings);
  const Sim3d guess = rough_guess(scene.truth);
  const Sim3Estimate result = estimate_sim3(scene.matches, scene.camera, guess);
  ASSERT_EQ(result.status, Sim3Status::kOk);
  EXPECT_FALSE(result.scale_determined);
  EXPECT_EQ(result.num_depth_inliers, 0);
  // The scale is that of the guess; with it right, so would be the rest.
  EXPECT_NEAR(result.S_current_candidate.scale(), guess.scale(), 1e-9);
  const double correction = scene.truth.scale() / guess.scale();
  const SO3d& R = result.S_current_candidate.rotation();
  EXPECT_LT((R * scene.truth.rotation().inverse()).log().norm(), 0.008);
  EXPECT_LT((correction * result.S_current_candidate.translation() - scene.truth.translation()).norm(), 0.08);
  EXPECT_EQ(result.information.row(6).norm(), 0);
  EXPECT_EQ(result.information.col(6).norm(), 0);
  const auto uncertainty = sim3_uncertainty(result.information);
  ASSERT_TRUE(uncertainty);
  EXPECT_TRUE(std::isinf(uncertainty->log_scale));
  EXPECT_LT(uncertainty->rotation_rad, 0.01);
  expect_finite(result);
}

TEST(Sim3EstimatorTest, TooFewDepthsDoNotDetermineTheScale) {
  Sim3SceneSettings settings;
  settings.depth_share = 0;
  Sim3Scene scene = make_sim3_scene(6, settings);
  for (int i = 0; i < 4; ++i) {
    scene.matches[i].idepth = 1 / (scene.truth * scene.matches[i].point.mean).z();
    scene.matches[i].idepth_stddev = 0.05 * scene.matches[i].idepth;
  }
  const Sim3Estimate result = estimate(scene);
  EXPECT_EQ(result.status, Sim3Status::kOk);
  EXPECT_FALSE(result.scale_determined);
  SimilaritySettings four;
  four.min_depth_inliers = 4;
  EXPECT_TRUE(estimate_sim3(scene.matches, scene.camera, rough_guess(scene.truth), four).scale_determined);
}

TEST(Sim3EstimatorTest, TooFew) {
  Sim3Scene scene = make_sim3_scene(7);
  const std::span<const Sim3Correspondence> all(scene.matches);
  for (const std::size_t count : {0, 1, 3, 9}) {
    const Sim3Estimate result = estimate_sim3(all.first(count), scene.camera, scene.truth);
    EXPECT_EQ(result.status, Sim3Status::kTooFew) << count;
    EXPECT_EQ(result.is_inlier.size(), count);
    expect_finite(result);
  }
  EXPECT_EQ(estimate_sim3(all.first(12), scene.camera, scene.truth).status, Sim3Status::kOk);
}

TEST(Sim3EstimatorTest, NothingButOutliers) {
  Sim3SceneSettings settings;
  settings.outlier_share = 1;
  settings.count = 60;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Sim3Estimate result = estimate(make_sim3_scene(seed, settings));
    EXPECT_NE(result.status, Sim3Status::kOk) << result.num_inliers;
    expect_finite(result);
  }
}

TEST(Sim3EstimatorTest, DegenerateMatches) {
  const Sim3Scene scene = make_sim3_scene(8);
  std::vector<Sim3Correspondence> one_place(50, scene.matches[0]);
  Sim3Estimate result = estimate_sim3(one_place, scene.camera, scene.truth);
  EXPECT_EQ(result.status, Sim3Status::kDegenerate);
  expect_finite(result);

  std::vector<Sim3Correspondence> line = scene.matches;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double t = static_cast<double>(i) / 150;
    line[i].point.mean = Eigen::Vector3d(t, 0.3 - t, 4 + 2 * t);
    line[i].pixel = project(scene.camera, scene.truth * line[i].point.mean);
    line[i].idepth = 0;
  }
  result = estimate_sim3(line, scene.camera, scene.truth);
  EXPECT_EQ(result.status, Sim3Status::kDegenerate);
  expect_finite(result);
}

TEST(Sim3EstimatorTest, UselessGuess) {
  const Sim3Scene scene = make_sim3_scene(9);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double scale : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    const Sim3Estimate result =
        estimate_sim3(scene.matches, scene.camera, Sim3d(SO3d(), Eigen::Vector3d::Zero(), scale));
    EXPECT_EQ(result.status, Sim3Status::kDegenerate);
    expect_finite(result);
  }
  const Sim3d nowhere(SO3d(), Eigen::Vector3d(nan, 0, 0), 1);
  EXPECT_EQ(estimate_sim3(scene.matches, scene.camera, nowhere).status, Sim3Status::kDegenerate);
  // Everything behind the camera.
  const Sim3d behind(SO3d(), Eigen::Vector3d(0, 0, -100), 1);
  const Sim3Estimate result = estimate_sim3(scene.matches, scene.camera, behind);
  EXPECT_NE(result.status, Sim3Status::kOk);
  expect_finite(result);
}

TEST(Sim3EstimatorTest, MatchesThatAreNotFiniteAreNeverInliers) {
  Sim3Scene scene = make_sim3_scene(10);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  scene.matches[0].point.mean.x() = nan;
  scene.matches[1].pixel.x() = inf;
  scene.matches[2].point.covariance(0, 0) = nan;
  scene.matches[3].idepth = nan;
  scene.matches[4].sigma_px = 0;
  scene.matches[5].point.covariance = -Eigen::Matrix3d::Identity();  // not a covariance
  scene.matches[5].sigma_px = 1e-3;
  const Sim3Estimate result = estimate(scene);
  ASSERT_EQ(result.status, Sim3Status::kOk);
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(result.is_inlier[i]) << i;
  EXPECT_GE(result.num_inliers, 138);
  expect_finite(result);
}

TEST(Sim3EstimatorTest, SameInputSameBits) {
  Sim3SceneSettings settings;
  settings.outlier_share = 0.3;
  const Sim3Scene scene = make_sim3_scene(11, settings);
  const Sim3Estimate first = estimate(scene), second = estimate(scene);
  EXPECT_EQ(first.S_current_candidate.matrix(), second.S_current_candidate.matrix());
  EXPECT_EQ(first.information, second.information);
}

TEST(InitialSim3Test, MedianOfTheDepthRatios) {
  Sim3SceneSettings settings;
  settings.outlier_share = 0.3;
  const Sim3Scene scene = make_sim3_scene(12, settings);
  const SE3d T(scene.truth.rotation(), scene.truth.translation() / scene.truth.scale());
  const std::optional<Sim3d> guess = initial_sim3(scene.matches, T);
  ASSERT_TRUE(guess);
  EXPECT_NEAR(std::log(guess->scale() / scene.truth.scale()), 0, 0.05);
  EXPECT_LT((guess->translation() - scene.truth.translation()).norm(), 0.05);
  settings.depth_share = 0;
  EXPECT_FALSE(initial_sim3(make_sim3_scene(12, settings).matches, T));
  EXPECT_FALSE(initial_sim3({}, T));
}

TEST(Sim3UncertaintyTest, WorstDirectionOfEachKind) {
  Vector7d stddev;
  stddev << 0.1, 0.3, 0.2, 0.01, 0.02, 0.005, 0.04;
  Matrix7d information = stddev.cwiseAbs2().cwiseInverse().asDiagonal();
  const auto uncertainty = sim3_uncertainty(information);
  ASSERT_TRUE(uncertainty);
  EXPECT_NEAR(uncertainty->translation, 0.3, 1e-12);
  EXPECT_NEAR(uncertainty->rotation_rad, 0.02, 1e-12);
  EXPECT_NEAR(uncertainty->log_scale, 0.04, 1e-12);
  information(1, 1) = 0;
  EXPECT_FALSE(sim3_uncertainty(information));
  EXPECT_FALSE(sim3_uncertainty(Matrix7d::Zero()));
}

}  // namespace
}  // namespace ldso
