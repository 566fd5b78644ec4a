#include "odometry/tracking/alignment_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "image/test_forced_target.h"
#include "odometry/state/brightness.h"
#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

using test::random_float;
using test::uniform;

Image<Texel> random_texels(int width, int height, double invalid, std::mt19937& random) {
  Image<Texel> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float grey = 120 + 30 * std::sin(0.2f * static_cast<float>(x + 2 * y));
      image(x, y) = {grey + random_float(random, -4, 4), random_float(random, -20, 20), random_float(random, -20, 20),
                     uniform(random, 0, 1) < invalid ? 0.0f : 1.0f};
    }
  }
  return image;
}

AlignmentPoints random_points(int count, std::mt19937& random) {
  AlignmentPoints points;
  for (int i = 0; i < count; ++i) {
    points.u.push_back(random_float(random, -4, 66));
    points.v.push_back(random_float(random, -4, 50));
    points.idepth.push_back(random_float(random, 0.1, 1));
    points.intensity.push_back(random_float(random, 85, 155));
  }
  return points;
}

AlignmentWarp random_warp(const Image<Texel>& image, bool far, std::mt19937& random) {
  AlignmentWarp warp;
  warp.texels = image.data();
  warp.width = image.width();
  warp.height = image.height();
  warp.fx = 50, warp.fy = 52, warp.cx = 30, warp.cy = 23;
  const float Ki[9] = {1 / warp.fx, 0, -warp.cx / warp.fx, 0, 1 / warp.fy, -warp.cy / warp.fy, 0, 0, 1};
  const double turn = far ? 0.003 : 0.0005;
  for (int i = 0; i < 9; ++i) warp.RKi[i] = Ki[i] + random_float(random, -turn, turn);
  for (float& t : warp.t) t = far ? random_float(random, -1.6, 1.6) : random_float(random, -0.1, 0.1);
  warp.factor = random_float(random, 0.9, 1.1);
  warp.offset = random_float(random, -8, 8);
  warp.ref_b = random_float(random, -5, 5);
  return warp;
}

void add_random_readout(AlignmentWarp& warp, std::mt19937& random) {
  for (float& x : warp.translation) x = random_float(random, -0.05, 0.05);
  for (float& x : warp.rotation) x = random_float(random, -0.05, 0.05);
}

/// Index of the product of variables a <= b.
int product_index(int a, int b) {
  int k = 0;
  for (int i = 0; i < a; ++i) k += kAlignmentDof + 1 - i;
  return k + b - a;
}

/// Sizes of the variables' Jacobians and of the residual before terms cancel:
/// rounding errors are relative to them. A single point may lie where depth
/// changes nothing though its gradient is steep, or have a residual near zero.
std::array<double, kAlignmentDof + 1> sizes(const AlignmentSums& sums) {
  const auto squared = [&](int a) { return static_cast<double>(sums.products[product_index(a, a)]); };
  const double translation = std::sqrt(squared(0) + squared(1) + squared(2));
  const double rotation = std::sqrt(squared(3) + squared(4) + squared(5));
  return {translation,
          translation,
          translation,
          rotation,
          rotation,
          rotation,
          std::sqrt(squared(6)),
          std::sqrt(squared(7)),
          std::sqrt(squared(8) + sums.count)};
}

void expect_same(const AlignmentSums& actual, const AlignmentSums& expected) {
  EXPECT_EQ(actual.count, expected.count);
  EXPECT_EQ(actual.saturated, expected.saturated);
  EXPECT_NEAR(actual.energy, expected.energy, 1e-4f * expected.energy + 1e-4f);
  const auto size = sizes(expected);
  for (int a = 0; a <= kAlignmentDof; ++a) {
    for (int b = a; b <= kAlignmentDof; ++b) {
      const int k = product_index(a, b);
      EXPECT_NEAR(actual.products[k], expected.products[k], 1e-4 * size[a] * size[b])
          << "product of " << a << " and " << b;
    }
  }
}

class AlignmentKernels : public testing::TestWithParam<std::int64_t> {
 protected:
  AlignmentKernels() : target_(GetParam()) {}
  test::ForcedTarget target_;
  std::mt19937 random_{3};
};

TEST_P(AlignmentKernels, MatchReferenceForAllCounts) {
  const Image<Texel> image = random_texels(63, 47, 0.03, random_);
  for (int count = 0; count <= 40; ++count) {
    SCOPED_TRACE(std::to_string(count) + " points");
    const AlignmentPoints points = random_points(count, random_);
    const AlignmentWarp warp = random_warp(image, false, random_);
    expect_same(align_points(points, 0, count, warp), align_points_reference(points, 0, count, warp));
  }
}

TEST_P(AlignmentKernels, MatchReferenceOnRangesAndFarMotions) {
  float in_view = 0, saturated = 0;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Image<Texel> image = random_texels(63, 47, 0.02, random_);
    const AlignmentPoints points = random_points(333, random_);
    const AlignmentWarp warp = random_warp(image, true, random_);
    const int begin = round % 13, end = 333 - round % 7;
    const AlignmentSums expected = align_points_reference(points, begin, end, warp);
    expect_same(align_points(points, begin, end, warp), expected);
    in_view += expected.count;
    saturated += expected.saturated;
  }
  // The draw has to contain what it is meant to test.
  EXPECT_GT(in_view, 1000);
  EXPECT_LT(in_view, 40 * 300);
  EXPECT_GT(saturated, 300);
}

TEST_P(AlignmentKernels, MatchReferenceWithARollingShutter) {
  float in_view = 0;
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Image<Texel> image = random_texels(63, 47, 0.02, random_);
    const AlignmentPoints points = random_points(203, random_);
    AlignmentWarp warp = random_warp(image, false, random_);
    const float still = align_points_reference(points, 0, 203, warp).energy;
    add_random_readout(warp, random_);
    const AlignmentSums expected = align_points_reference(points, 0, 203, warp);
    expect_same(align_points(points, 0, 203, warp), expected);
    EXPECT_NE(expected.energy, still);
    in_view += expected.count;
  }
  EXPECT_GT(in_view, 1000);
}

TEST_P(AlignmentKernels, SaturatedResidualsCountWithTheCutoffsEnergyOnly) {
  const Image<Texel> image(63, 47, Texel{200, 5, -7, 1});
  AlignmentPoints points = random_points(100, random_);
  AlignmentWarp warp = random_warp(image, false, random_);
  warp.factor = 1;
  warp.offset = 0;
  for (float& intensity : points.intensity) intensity = 100;
  const AlignmentSums sums = align_points(points, 0, points.size(), warp);
  ASSERT_GT(sums.count, 30);
  EXPECT_EQ(sums.saturated, sums.count);
  EXPECT_NEAR(sums.energy, sums.count * (2 * 9 * 20 - 81), 1e-3 * sums.energy);
  for (const float product : sums.products) EXPECT_EQ(product, 0);
}

TEST_P(AlignmentKernels, NothingInViewGivesNothing) {
  const Image<Texel> image = random_texels(63, 47, 0, random_);
  const AlignmentPoints points = random_points(50, random_);
  AlignmentWarp warp = random_warp(image, false, random_);
  warp.t[0] = 1e3f;
  const AlignmentSums aside = align_points(points, 0, 50, warp);
  warp.t[0] = 0;
  warp.t[2] = -20;  // All behind the camera.
  const AlignmentSums behind = align_points(points, 0, 50, warp);
  for (const AlignmentSums& sums : {aside, behind}) {
    EXPECT_EQ(sums.count, 0);
    EXPECT_EQ(sums.energy, 0);
    for (const float product : sums.products) EXPECT_EQ(product, 0);
  }
}

/// A slope of grey values, one point, and its residual in double as a function
/// of pose and brightness.
struct OnePoint {
  static constexpr double kSlopeX = 3, kSlopeY = -2, kFx = 50, kFy = 52, kCx = 30, kCy = 23;
  static constexpr double kU = 20, kV = 31, kIdepth = 0.4, kGrey = 95, kRefA = 0.1, kRefB = 3;

  static BrightnessTransfer transfer(const Brightness& brightness) {
    return brightness_transfer(1.0, {kRefA, kRefB}, 1.0, brightness);
  }

  static double residual(const SE3d& T_new_ref, const Brightness& brightness) {
    const Eigen::Vector3d ray((kU - kCx) / kFx, (kV - kCy) / kFy, 1);
    const Eigen::Vector3d p = T_new_ref * Eigen::Vector3d(ray / kIdepth);
    const double u = kFx * p.x() / p.z() + kCx, v = kFy * p.y() / p.z() + kCy;
    const BrightnessTransfer t = transfer(brightness);
    return 100 + kSlopeX * u + kSlopeY * v - (t.factor * kGrey + t.offset);
  }
};

TEST(AlignmentJacobian, OfOnePointMatchesNumericDifferences) {
  using P = OnePoint;
  Image<Texel> image(63, 47);
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 63; ++x) {
      image(x, y) = {static_cast<float>(100 + P::kSlopeX * x + P::kSlopeY * y), P::kSlopeX, P::kSlopeY, 1};
    }
  }
  SE3d::Tangent motion;
  motion << 0.1, -0.05, 0.2, 0.03, -0.02, 0.05;
  const SE3d T_new_ref = SE3d::exp(motion);
  const Brightness brightness{-0.05, 4};
  const BrightnessTransfer transfer = P::transfer(brightness);
  AlignmentWarp warp;
  warp.texels = image.data();
  warp.width = 63, warp.height = 47;
  warp.fx = P::kFx, warp.fy = P::kFy, warp.cx = P::kCx, warp.cy = P::kCy;
  Eigen::Matrix3d K;
  K << P::kFx, 0, P::kCx, 0, P::kFy, P::kCy, 0, 0, 1;
  const Eigen::Matrix3d RKi = T_new_ref.rotation_matrix() * K.inverse();
  for (int i = 0; i < 9; ++i) warp.RKi[i] = static_cast<float>(RKi(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) warp.t[i] = static_cast<float>(T_new_ref.translation()[i]);
  warp.factor = static_cast<float>(transfer.factor);
  warp.offset = static_cast<float>(transfer.offset);
  warp.ref_b = P::kRefB;
  warp.huber = 1e6f, warp.cutoff = 1e6f;
  const AlignmentPoints points{{P::kU}, {P::kV}, {P::kIdepth}, {P::kGrey}};
  const AlignmentSums sums = align_points(points, 0, 1, warp);
  const double r = P::residual(T_new_ref, brightness);
  ASSERT_EQ(sums.count, 1);
  ASSERT_GT(std::abs(r), 1);
  EXPECT_NEAR(sums.products[product_index(8, 8)], r * r, 1e-4 * r * r);
  for (int i = 0; i < kAlignmentDof; ++i) {
    const auto at = [&](double step) {
      SE3d::Tangent x = SE3d::Tangent::Zero();
      if (i < 6) x[i] = step;
      return P::residual(SE3d::exp(x) * T_new_ref,
                         {brightness.a + (i == 6 ? step : 0), brightness.b + (i == 7 ? step : 0)});
    };
    const double numeric = (at(1e-5) - at(-1e-5)) / 2e-5;
    EXPECT_NEAR(sums.products[product_index(i, 8)] / r, numeric, 2e-4 * std::abs(numeric) + 1e-3) << "variable " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, AlignmentKernels, testing::ValuesIn(test::processor_targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace ldso
