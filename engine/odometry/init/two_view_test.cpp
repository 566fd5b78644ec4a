#include "odometry/init/two_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{640, 480, 500, 500, 320, 240};
constexpr double kNoise = 0.3;  // [px]

double uniform(std::mt19937& generator, double low, double high) {
  return low + (high - low) * (generator() / 4294967296.0);
}

struct Case {
  std::vector<TwoViewMatch> matches;
  std::vector<double> idepth;
};

/// Points between 2 and 10 deep, a share of the matches wrong.
Case make_case(const SE3d& T, int count, double wrong) {
  std::mt19937 generator(3);
  Case result;
  while (static_cast<int>(result.matches.size()) < count) {
    const double u = uniform(generator, 10, 630), v = uniform(generator, 10, 470);
    const double idepth = uniform(generator, 0.1, 0.5);
    const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1);
    const Eigen::Vector3d q = T.rotation() * ray + idepth * T.translation();
    Eigen::Vector2d target(kCamera.fx * q.x() / q.z() + kCamera.cx, kCamera.fy * q.y() / q.z() + kCamera.cy);
    target += 1.7 * Eigen::Vector2d(uniform(generator, -kNoise, kNoise), uniform(generator, -kNoise, kNoise));
    if (uniform(generator, 0, 1) < wrong) {
      target += Eigen::Vector2d(uniform(generator, -30, 30), uniform(generator, -30, 30));
    }
    result.matches.push_back({ray, target, Eigen::Matrix2d::Identity() / kNoise});
    result.idepth.push_back(idepth);
  }
  return result;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

class TwoViewTest : public ::testing::TestWithParam<Eigen::Vector3d> {
 protected:
  ThreadPool pool_{2};
};

TEST_P(TwoViewTest, FindsTheMotionAmongOutliers) {
  const SE3d T(SO3d::exp({0.02, -0.03, 0.01}), 0.15 * GetParam().normalized());
  const Case data = make_case(T, 600, 0.25);
  const TwoViewFit fit = fit_motion(data.matches, kCamera, SO3d(), std::nullopt, pool_);
  EXPECT_LT(angle_between(fit.T_second_first.translation(), T.translation()), 1.5);
  EXPECT_LT((fit.T_second_first.rotation() * T.rotation().inverse()).log().norm() * 180 / M_PI, 0.1);
  EXPECT_NEAR(fit.T_second_first.translation().norm(), 1, 1e-9);
  EXPECT_GT(fit.direction_stddev, 0);
  EXPECT_LT(fit.direction_stddev * 180 / M_PI, 2);
  EXPECT_GT(fit.runner_up_ratio, 1.1);
  int inliers = 0;
  for (const double e : fit.error) inliers += e < 3;
  EXPECT_GT(inliers, 0.7 * 600);
  EXPECT_LT(fit.cost, 0.5 * fit_rotation(data.matches, kCamera, SO3d()).cost);
}

INSTANTIATE_TEST_SUITE_P(Directions, TwoViewTest,
                         ::testing::Values(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0),
                                           Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1),
                                           Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, -2, 3),
                                           Eigen::Vector3d(-2, 1, -1)));

TEST(TwoView, IdepthsAreRight) {
  const SE3d T(SO3d(), Eigen::Vector3d(0.5, 0, 0));
  const Case data = make_case(T, 400, 0);
  ThreadPool pool(1);
  const TwoViewFit fit = fit_motion(data.matches, kCamera, SO3d(), std::nullopt, pool);
  for (std::size_t i = 0; i < data.idepth.size(); ++i) EXPECT_NEAR(fit.idepth[i] / 0.5, data.idepth[i], 0.02);
}

TEST(TwoView, RotationAloneLeavesNothingToExplain) {
  const SE3d T(SO3d::exp({0.05, 0.1, -0.03}), Eigen::Vector3d::Zero());
  const Case data = make_case(T, 400, 0.1);
  ThreadPool pool(2);
  const TwoViewFit rotation = fit_rotation(data.matches, kCamera, SO3d());
  EXPECT_LT((rotation.T_second_first.rotation() * T.rotation().inverse()).log().norm() * 180 / M_PI, 0.02);
  const TwoViewFit motion = fit_motion(data.matches, kCamera, rotation.T_second_first.rotation(), std::nullopt, pool);
  double parallax = 0;
  for (std::size_t i = 0; i < data.matches.size(); ++i) parallax += motion.idepth[i] * kCamera.fx / 400;
  EXPECT_LT(parallax, 3);
}

}  // namespace
}  // namespace ldso
