#include "mapping/map/uncertain_point.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{640, 480, 500, 510, 320.5, 239.5};

TEST(UncertainPointTest, BackProjectionIsTheInverseOfProjection) {
  const Eigen::Vector2d pixel(100, 300);
  const UncertainPoint point = back_project(kCamera, pixel, 1, 0.25, 0.01);
  EXPECT_LT((project(kCamera, point.mean) - pixel).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(point.mean.z(), 4);
}

// Covariances against the sample covariance of many disturbed points.
TEST(UncertainPointTest, CovarianceIsThatOfSamples) {
  const Eigen::Vector2d pixel(120, 400);
  const double idepth = 0.25, stddev = 0.004, sigma = 1.5;
  const Sim3d S(SO3d::exp(Eigen::Vector3d(0.4, 1, -0.3)), Eigen::Vector3d(1, 2, 3), 1.7);
  const UncertainPoint point = S * back_project(kCamera, pixel, sigma, idepth, stddev);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(0, 1);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d noise(normal(generator), normal(generator));
    const Eigen::Vector3d ray = viewing_ray(kCamera, pixel + sigma * noise);
    const Eigen::Vector3d error = S * (ray / (idepth + stddev * normal(generator))) - point.mean;
    sum += error * error.transpose();
  }
  EXPECT_LT((sum / kSamples - point.covariance).norm(), 0.03 * point.covariance.norm());
  // The small part across the ray too: in units of the covariance it is the identity.
  const Eigen::Matrix3d L = point.covariance.llt().matrixL();
  const Eigen::Matrix3d whitened = L.inverse() * (sum / kSamples) * L.transpose().inverse();
  EXPECT_LT((whitened - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.04);
}

TEST(PinholeProjectionTest, JacobianIsTheDerivative) {
  const Eigen::Vector3d p(0.7, -1.2, 3.1);
  const Eigen::Matrix<double, 2, 3> J = projection_jacobian(kCamera, p);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
    const Eigen::Vector2d slope = (project(kCamera, p + step) - project(kCamera, p - step)) / 2e-6;
    EXPECT_LT((J.col(k) - slope).norm(), 1e-6) << k;
  }
}

}  // namespace
}  // namespace ldso
