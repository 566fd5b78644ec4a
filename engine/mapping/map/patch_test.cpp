#include "mapping/map/patch.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "mapping/verification/test_textured_plane.h"

namespace ldso {
namespace {

using loop_test::Texture;

constexpr int kSize = 48;
const Eigen::Matrix2d kNoWarp = Eigen::Matrix2d::Identity();
const Eigen::Vector2d kCentre(24, 24);

/// Of `grey` at each pixel less `kCentre`.
Image<Texel> image_of(const std::function<double(Eigen::Vector2d)>& grey, double noise = 0, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Image<float> image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      image(x, y) = static_cast<float>(grey(Eigen::Vector2d(x, y) - kCentre) + noise * normal(random));
    }
  }
  return loop_test::texels(image);
}

double texture(const Eigen::Vector2d& p) {
  static const Texture kTexture(5, 6, 40);
  return kTexture(p.x(), p.y());
}

Patch cut_at_centre(const Image<Texel>& image) {
  return cut_patch(image, static_cast<float>(kCentre.x()), static_cast<float>(kCentre.y()));
}

const Patch& patch() {
  static const Patch kPatch = cut_at_centre(image_of(texture));
  return kPatch;
}

TEST(PatchTest, CutsTheGreyLevelsAroundThePixel) {
  const Image<Texel> image = image_of(texture);
  const Patch cut = cut_patch(image, 20.3f, 10.8f);
  for (int i = 0; i < Patch::kPixels; ++i) {
    const double expected = image(17 + i % Patch::kSide, 8 + i / Patch::kSide).intensity;
    EXPECT_NEAR(cut.grey[i], expected, 0.51);
  }
}

TEST(PatchTest, IsBlackWhereAPixelIsMissing) {
  Image<Texel> image = image_of(texture);
  const Patch black;
  EXPECT_EQ(cut_patch(image, 2, 24).grey, black.grey);
  EXPECT_EQ(cut_patch(image, 24, kSize - 3).grey, black.grey);
  EXPECT_EQ(cut_patch(image, std::numeric_limits<float>::quiet_NaN(), 24).grey, black.grey);
  EXPECT_NE(cut_patch(image, 3, 24).grey, black.grey);
  image(22, 25).valid = 0;
  EXPECT_EQ(cut_patch(image, 24, 24).grey, black.grey);
}

TEST(PatchTest, IsFoundBetweenPixels) {
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0.3, -0.45), {-1.2, 0.8}, {0, 0}}) {
    const Image<Texel> moved = image_of([&](const Eigen::Vector2d& p) { return texture(p - shift); });
    const auto found = align_patch(patch(), moved, kCentre, kNoWarp);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pixel - kCentre - shift).norm(), 0.03) << shift.transpose();
  }
}

TEST(PatchTest, IsFoundInOtherLight) {
  const Eigen::Vector2d shift(0.4, 0.7);
  const Image<Texel> moved = image_of([&](const Eigen::Vector2d& p) { return 0.6 * texture(p - shift) + 35; });
  const auto found = align_patch(patch(), moved, kCentre, kNoWarp);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pixel - kCentre - shift).norm(), 0.03);
}

TEST(PatchTest, IsFoundTurnedAndEnlarged) {
  Eigen::Matrix2d warp;
  warp << 1.2, -0.25, 0.3, 1.1;
  const Eigen::Vector2d shift(-0.6, 0.35);
  const Eigen::Matrix2d back = warp.inverse();
  const Image<Texel> moved = image_of([&](const Eigen::Vector2d& p) { return texture(back * (p - shift)); });
  const auto found = align_patch(patch(), moved, kCentre, warp);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pixel - kCentre - shift).norm(), 0.03);
  EXPECT_FALSE(align_patch(patch(), moved, kCentre, Eigen::Matrix2d(3 * kNoWarp)));
}

TEST(PatchTest, CovarianceTellsTheError) {
  const Eigen::Vector2d shift(0.3, 0.2);
  double sum = 0;
  constexpr int kRuns = 200;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Patch noisy = cut_at_centre(image_of(texture, 2, 2 * seed));
    const Image<Texel> moved = image_of([&](const Eigen::Vector2d& p) { return texture(p - shift); }, 2, 2 * seed + 1);
    const auto found = align_patch(noisy, moved, kCentre, kNoWarp);
    ASSERT_TRUE(found);
    const Eigen::Vector2d error = found->pixel - kCentre - shift;
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  // 2 where the covariance is right.
  EXPECT_GT(sum / kRuns, 1.3);
  EXPECT_LT(sum / kRuns, 3.2);
}

TEST(PatchTest, IsNotFoundWhereItIsNot) {
  const Texture other(77, 6, 40);
  EXPECT_FALSE(
      align_patch(patch(), image_of([&](const Eigen::Vector2d& p) { return other(p.x(), p.y()); }), kCentre, kNoWarp));
  EXPECT_FALSE(align_patch(patch(), image_of([](const Eigen::Vector2d&) { return 90; }), kCentre, kNoWarp));
  const Image<Texel> far = image_of([](const Eigen::Vector2d& p) { return texture(p - Eigen::Vector2d(6, 0)); });
  const auto found = align_patch(patch(), far, kCentre, kNoWarp);
  EXPECT_FALSE(found);
}

TEST(PatchTest, FindsNothingForUselessInput) {
  const Image<Texel> image = image_of(texture);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(align_patch(patch(), image, kCentre, kNoWarp));
  EXPECT_FALSE(align_patch(Patch(), image, kCentre, kNoWarp));
  EXPECT_FALSE(align_patch(patch(), image, {kNaN, 24}, kNoWarp));
  EXPECT_FALSE(align_patch(patch(), image, kCentre, Eigen::Matrix2d::Constant(kNaN)));
  EXPECT_FALSE(align_patch(patch(), image, {1, 24}, kNoWarp));
  EXPECT_FALSE(align_patch(patch(), image, {1e9, -1e9}, kNoWarp));
  EXPECT_FALSE(align_patch(patch(), Image<Texel>(3, 3), kCentre, kNoWarp));
  // Only edges of one direction: the place along them is unknown.
  const auto stripes = [](const Eigen::Vector2d& p) { return 128 + 60 * std::sin(p.x() / 2); };
  const Image<Texel> striped = image_of(stripes);
  const auto found = align_patch(cut_at_centre(striped), striped, kCentre, kNoWarp);
  EXPECT_TRUE(!found || found->covariance.trace() > 1);
}

}  // namespace
}  // namespace ldso
