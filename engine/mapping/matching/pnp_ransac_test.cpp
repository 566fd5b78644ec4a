#include "mapping/matching/pnp_ransac.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{640, 480, 500, 510, 320.5, 239.5};
const SE3d kTruth(SO3d::exp(Eigen::Vector3d(0.2, -0.5, 0.1)), Eigen::Vector3d(0.3, -0.2, 0.6));

struct Scene {
  std::vector<PnpCorrespondence> correspondences;
  std::vector<bool> is_true;
};

/// Points 2 to 10 units in front of the camera, pixels with noise, a share of them anywhere in the image.
Scene make_scene(int count, double noise_px, double outlier_share, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> u(0, 639), v(0, 479), depth(2, 10), share(0, 1);
  std::normal_distribution<double> normal(0, 1);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(u(generator), v(generator));
    PnpCorrespondence c;
    c.point = kTruth.inverse() * (depth(generator) * viewing_ray(kCamera, pixel));
    const bool is_true = share(generator) >= outlier_share;
    const Eigen::Vector2d noise(normal(generator), normal(generator));
    const Eigen::Vector2d anywhere(u(generator), v(generator));
    c.pixel = is_true ? Eigen::Vector2d(pixel + noise_px * noise) : anywhere;
    scene.correspondences.push_back(c);
    scene.is_true.push_back(is_true);
  }
  return scene;
}

double rotation_error(const SE3d& T) { return (T.rotation() * kTruth.rotation().inverse()).log().norm(); }
double translation_error(const SE3d& T) { return (T.translation() - kTruth.translation()).norm(); }

TEST(PnpRansacTest, ExactWithoutNoise) {
  const Scene scene = make_scene(20, 0, 0, 1);
  const auto result = pnp_ransac(scene.correspondences, kCamera);
  ASSERT_TRUE(result);
  EXPECT_LT(rotation_error(result->T_camera_points), 1e-9);
  EXPECT_LT(translation_error(result->T_camera_points), 1e-9);
  EXPECT_EQ(result->inliers.size(), 20u);
}

TEST(PnpRansacTest, FindsThePoseAmongManyOutliers) {
  for (const double outliers : {0.3, 0.5, 0.7}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Scene scene = make_scene(120, 1, outliers, seed);
      const auto result = pnp_ransac(scene.correspondences, kCamera);
      ASSERT_TRUE(result) << outliers << " " << seed;
      EXPECT_LT(rotation_error(result->T_camera_points), 0.006) << outliers << " " << seed;
      EXPECT_LT(translation_error(result->T_camera_points), 0.03) << outliers << " " << seed;
      const auto total = std::count(scene.is_true.begin(), scene.is_true.end(), true);
      int found = 0;
      for (const int i : result->inliers) found += scene.is_true[i] ? 1 : 0;
      EXPECT_GE(found, 0.9 * static_cast<double>(total));  // 3 sigma in two dimensions: 98.9 %
      EXPECT_LE(result->inliers.size() - static_cast<std::size_t>(found), 2u);
    }
  }
}

// Local optimization makes the answer that of all inliers: the minimum of their sum of squares.
TEST(PnpRansacTest, ResultIsTheLeastSquaresOfItsInliers) {
  const Scene scene = make_scene(100, 1, 0.4, 3);
  const auto result = pnp_ransac(scene.correspondences, kCamera);
  ASSERT_TRUE(result);
  const auto sum = [&](const SE3d& T) {
    double total = 0;
    for (const int i : result->inliers) {
      const PnpCorrespondence& c = scene.correspondences[i];
      total += (project(kCamera, T * c.point) - c.pixel).squaredNorm();
    }
    return total;
  };
  const double least = sum(result->T_camera_points);
  for (int k = 0; k < 6; ++k) {
    for (const double step : {-1e-4, 1e-4}) {
      EXPECT_GT(sum(SE3d::exp(step * SE3d::Tangent::Unit(k)) * result->T_camera_points), least) << k;
    }
  }
}

TEST(PnpRansacTest, StopsEarlyWhenAllAgree) {
  const auto easy = pnp_ransac(make_scene(100, 0.5, 0, 4).correspondences, kCamera);
  const auto hard = pnp_ransac(make_scene(100, 0.5, 0.6, 4).correspondences, kCamera);
  ASSERT_TRUE(easy && hard);
  EXPECT_LE(easy->iterations, 10);
  EXPECT_GT(hard->iterations, 50);
  EXPECT_LT(hard->iterations, 500);
}

TEST(PnpRansacTest, SameSeedSameBits) {
  const Scene scene = make_scene(80, 1, 0.6, 5);
  const auto first = pnp_ransac(scene.correspondences, kCamera);
  const auto second = pnp_ransac(scene.correspondences, kCamera);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->T_camera_points.matrix(), second->T_camera_points.matrix());
  EXPECT_EQ(first->inliers, second->inliers);
  EXPECT_EQ(first->iterations, second->iterations);
}

TEST(PnpRansacTest, SigmaWidensTheThreshold) {
  Scene scene = make_scene(60, 0.3, 0, 6);
  for (int i = 0; i < 10; ++i) {
    scene.correspondences[i].pixel += Eigen::Vector2d(8, 0);
    scene.correspondences[i].sigma_px = i < 5 ? 4 : 1;
  }
  const auto result = pnp_ransac(scene.correspondences, kCamera);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->inliers.size(), 55u);
  EXPECT_EQ(result->inliers[4], 4);
  EXPECT_EQ(result->inliers[5], 10);
}

TEST(PnpRansacTest, PlanarPointsAreEnough) {
  Scene scene = make_scene(60, 0.5, 0.3, 7);
  for (std::size_t i = 0; i < scene.is_true.size(); ++i) {
    PnpCorrespondence& c = scene.correspondences[i];
    if (!scene.is_true[i]) continue;
    const Eigen::Vector3d ray = viewing_ray(kCamera, c.pixel);
    c.point = kTruth.inverse() * (ray * 5 / ray.dot(Eigen::Vector3d(0.3, 0.1, 1)));
  }
  const auto result = pnp_ransac(scene.correspondences, kCamera);
  ASSERT_TRUE(result);
  EXPECT_LT(rotation_error(result->T_camera_points), 1e-5);
  EXPECT_LT(translation_error(result->T_camera_points), 1e-5);
}

TEST(PnpRansacTest, NothingFromTooFew) {
  const Scene scene = make_scene(20, 0.5, 0, 8);
  const std::span<const PnpCorrespondence> all(scene.correspondences);
  EXPECT_FALSE(pnp_ransac({}, kCamera));
  EXPECT_FALSE(pnp_ransac(all.first(9), kCamera));
  EXPECT_TRUE(pnp_ransac(all.first(10), kCamera));
  PnpSettings any;
  any.min_inliers = 0;
  EXPECT_FALSE(pnp_ransac(all.first(3), kCamera, any));  // three fit any pose
  EXPECT_TRUE(pnp_ransac(all.first(4), kCamera, any));
  EXPECT_FALSE(pnp_ransac(make_scene(60, 0.5, 1, 8).correspondences, kCamera));  // nothing but outliers
}

TEST(PnpRansacTest, NothingFromDegeneratePoints) {
  const Scene good = make_scene(40, 0, 0, 9);
  std::vector<PnpCorrespondence> one_place = good.correspondences;
  for (PnpCorrespondence& c : one_place) c = good.correspondences[0];
  EXPECT_FALSE(pnp_ransac(one_place, kCamera));

  std::vector<PnpCorrespondence> two_places = one_place;
  for (std::size_t i = 0; i < two_places.size(); i += 2) two_places[i] = good.correspondences[1];
  EXPECT_FALSE(pnp_ransac(two_places, kCamera));

  std::vector<PnpCorrespondence> line = good.correspondences;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double t = static_cast<double>(i) / 40;
    line[i].point = (1 - t) * good.correspondences[0].point + t * good.correspondences[1].point;
    line[i].pixel = project(kCamera, kTruth * line[i].point);
  }
  EXPECT_FALSE(pnp_ransac(line, kCamera));

  std::vector<PnpCorrespondence> one_pixel = good.correspondences;
  for (PnpCorrespondence& c : one_pixel) c.pixel = Eigen::Vector2d(100, 100);
  EXPECT_FALSE(pnp_ransac(one_pixel, kCamera));
}

TEST(PnpRansacTest, NumbersThatAreNotFiniteAreNeverInliers) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Scene scene = make_scene(40, 0.5, 0, 10);
  std::vector<PnpCorrespondence>& c = scene.correspondences;
  c[0].point.x() = nan;
  c[1].point.z() = inf;
  c[2].pixel.y() = nan;
  c[3].sigma_px = nan;
  c[4].sigma_px = 0;
  c[5].sigma_px = -1;
  const auto result = pnp_ransac(c, kCamera);
  ASSERT_TRUE(result);
  EXPECT_LT(rotation_error(result->T_camera_points), 0.006);
  EXPECT_GE(result->inliers.front(), 6);
  for (PnpCorrespondence& each : c) each.point.y() = nan;
  EXPECT_FALSE(pnp_ransac(c, kCamera));
  PinholeIntrinsics bad = kCamera;
  bad.fx = nan;
  EXPECT_FALSE(pnp_ransac(make_scene(40, 0.5, 0, 10).correspondences, bad));
}

}  // namespace
}  // namespace ldso
