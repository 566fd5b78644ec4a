#include "odometry/residual/residual_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "image/test_forced_target.h"
#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

using test::random_float;
using test::uniform;

/// A smooth image with noise and gradients of its own; `invalid` is the share of unusable texels.
Image<Texel> random_texels(int width, int height, double invalid, std::mt19937& random) {
  Image<Texel> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Texel& t = image(x, y);
      t.intensity = 120 + 70 * std::sin(0.2f * static_cast<float>(x) + 0.1f * static_cast<float>(y)) +
                    random_float(random, -9, 9);
      t.dx = random_float(random, -30, 30);
      t.dy = random_float(random, -30, 30);
      t.valid = uniform(random, 0, 1) < invalid ? 0.0f : 1.0f;
    }
  }
  return image;
}

PatternPatch random_patch(std::mt19937& random) {
  PatternPatch patch;
  for (int i = 0; i < kPatternSize; ++i) {
    patch.intensity[i] = random_float(random, 20, 230);
    patch.weight[i] = random_float(random, 0.2, 1);
  }
  return patch;
}

PatternWarp random_warp(const Image<Texel>& image, double turn, std::mt19937& random) {
  PatternWarp warp;
  warp.texels = image.data();
  warp.width = image.width();
  warp.height = image.height();
  for (int i = 0; i < 9; ++i) {
    const bool perspective = i == 6 || i == 7;
    warp.KRKi[i] = (i % 4 == 0 ? 1.0f : 0.0f) + random_float(random, -turn, turn) * (perspective ? 0.01f : 1.0f);
  }
  for (float& t : warp.Kt) t = random_float(random, -4, 4);
  warp.Kt[2] *= 0.6f;  // With inverse depths up to 1: sometimes behind the camera.
  warp.factor = random_float(random, 0.7, 1.4);
  warp.offset = random_float(random, -15, 15);
  warp.factor_lin = warp.factor * random_float(random, 0.95, 1.05);
  warp.host_b_lin = random_float(random, -10, 10);
  return warp;
}

void add_random_rolling(PatternWarp& warp, std::mt19937& random) {
  warp.rolling.on = true;
  for (int i = 0; i < 9; ++i) {
    const float size = i == 6 || i == 7 ? 0.0002f : i % 3 == 2 ? 3.0f : 0.03f;
    warp.rolling.host.KRKi[i] = size * random_float(random, -1, 1);
    warp.rolling.target_KwKi[i] = size * random_float(random, -1, 1);
  }
  for (int i = 0; i < 3; ++i) {
    const float size = i == 2 ? 0.03f : 2.0f;
    warp.rolling.host.Kt[i] = size * random_float(random, -1, 1);
    warp.rolling.target_Kv[i] = size * random_float(random, -1, 1);
  }
}

void expect_near(float actual, float expected, float size, const char* name) {
  EXPECT_NEAR(actual, expected, 5e-4f * size + 1e-4f) << name;
}

/// Mixed sums may cancel: they are compared relative to the sums of squares that bound them.
void expect_same(const PatternSums& a, const PatternSums& e) {
  ASSERT_EQ(a.in_view, e.in_view);
  if (!e.in_view) return;
  const float x = std::sqrt(e.gxx), y = std::sqrt(e.gyy), ia = std::sqrt(e.aa), ib = std::sqrt(e.bb),
              r = std::sqrt(e.energy);
  expect_near(a.gxx, e.gxx, e.gxx, "gxx");
  expect_near(a.gxy, e.gxy, x * y, "gxy");
  expect_near(a.gyy, e.gyy, e.gyy, "gyy");
  expect_near(a.gxa, e.gxa, x * ia, "gxa");
  expect_near(a.gya, e.gya, y * ia, "gya");
  expect_near(a.gxb, e.gxb, x * ib, "gxb");
  expect_near(a.gyb, e.gyb, y * ib, "gyb");
  expect_near(a.aa, e.aa, e.aa, "aa");
  expect_near(a.ab, e.ab, ia * ib, "ab");
  expect_near(a.bb, e.bb, e.bb, "bb");
  expect_near(a.rgx, e.rgx, x * r, "rgx");
  expect_near(a.rgy, e.rgy, y * r, "rgy");
  expect_near(a.ra, e.ra, ia * r, "ra");
  expect_near(a.rb, e.rb, ib * r, "rb");
  expect_near(a.energy, e.energy, e.energy, "energy");
}

class ResidualKernels : public testing::TestWithParam<std::int64_t> {
 protected:
  ResidualKernels() : target_(GetParam()) {}

  /// Compares many random patterns; returns how many were in view.
  int compare(double turn, double invalid, int rounds, bool rolling = false) {
    int in_view = 0;
    for (int round = 0; round < rounds; ++round) {
      const Image<Texel> image = random_texels(61, 47, invalid, random_);
      PatternWarp warp = random_warp(image, turn, random_);
      if (rolling) add_random_rolling(warp, random_);
      std::vector<PatternPatch> patches(101);
      std::vector<PatternJob> jobs;
      for (PatternPatch& patch : patches) {
        patch = random_patch(random_);
        jobs.push_back(
            {&patch, &warp, random_float(random_, -3, 64), random_float(random_, -3, 50), random_float(random_, 0, 1)});
      }
      std::vector<PatternSums> actual(jobs.size()), expected(jobs.size());
      evaluate_patterns(jobs.data(), actual.data(), static_cast<int>(jobs.size()));
      evaluate_patterns_reference(jobs.data(), expected.data(), static_cast<int>(jobs.size()));
      for (std::size_t i = 0; i < jobs.size(); ++i) {
        SCOPED_TRACE("round " + std::to_string(round) + " pattern " + std::to_string(i));
        expect_same(actual[i], expected[i]);
        in_view += expected[i].in_view ? 1 : 0;
      }
    }
    return in_view;
  }

  test::ForcedTarget target_;
  std::mt19937 random_{11};
};

TEST_P(ResidualKernels, MatchReferenceOnValidImages) { EXPECT_GT(compare(0.05, 0, 30), 300); }

TEST_P(ResidualKernels, MatchReferenceWithInvalidTexels) { EXPECT_GT(compare(0.05, 0.08, 40), 300); }

TEST_P(ResidualKernels, MatchReferenceWithARollingShutter) { EXPECT_GT(compare(0.05, 0.02, 40, true), 300); }

TEST_P(ResidualKernels, MatchReferenceUnderStrongRotation) { EXPECT_GT(compare(0.5, 0.02, 60), 100); }

TEST_P(ResidualKernels, PointsBehindTheCameraAreOutOfView) {
  const Image<Texel> image = random_texels(61, 47, 0, random_);
  const PatternPatch patch = random_patch(random_);
  PatternWarp warp = random_warp(image, 0, random_);
  warp.Kt[0] = warp.Kt[1] = 0;
  for (const float z : {-1.0f, -1.5f, -3.0f}) {
    warp.Kt[2] = z;
    // Mirrored at the origin the pixel would fall into the image: (-30, -20) / -1.
    for (const float sign : {1.0f, -1.0f}) {
      const PatternJob job{&patch, &warp, sign * 30, sign * 20, 1.0f};
      PatternSums sums;
      sums.in_view = true;
      evaluate_patterns(&job, &sums, 1);
      EXPECT_FALSE(sums.in_view);
    }
  }
}

TEST_P(ResidualKernels, APatternThatLeavesTheImageByOnePixelIsOutOfView) {
  const Image<Texel> image = random_texels(61, 47, 0, random_);
  const PatternPatch patch = random_patch(random_);
  PatternWarp warp = random_warp(image, 0, random_);
  for (float& t : warp.Kt) t = 0;
  const auto in_view = [&](float u, float v) {
    const PatternJob job{&patch, &warp, u, v, 0.5f};
    PatternSums sums;
    evaluate_patterns(&job, &sums, 1);
    return sums.in_view;
  };
  EXPECT_TRUE(in_view(3.1f, 3.1f));
  EXPECT_FALSE(in_view(2.9f, 20));
  EXPECT_FALSE(in_view(20, 2.9f));
  EXPECT_TRUE(in_view(61 - 4.1f, 47 - 4.1f));
  EXPECT_FALSE(in_view(61 - 3.9f, 20));
  EXPECT_FALSE(in_view(20, 47 - 3.9f));
}

TEST_P(ResidualKernels, HalfOfThePatternHasToBeValid) {
  const PatternPatch patch = random_patch(random_);
  for (int bad = 0; bad <= kPatternSize; ++bad) {
    Image<Texel> image(61, 47, Texel{100, 1, 2, 1});
    PatternWarp warp = random_warp(image, 0, random_);
    for (float& t : warp.Kt) t = 0;
    for (int i = 0; i < bad; ++i) image(20 + kPattern[i].dx, 20 + kPattern[i].dy).valid = 0;
    const PatternJob job{&patch, &warp, 20, 20, 0.5f};
    PatternSums actual, expected;
    evaluate_patterns(&job, &actual, 1);
    evaluate_patterns_reference(&job, &expected, 1);
    expect_same(actual, expected);
    // At integer positions the right and lower neighbours have no weight: exactly `bad` pixels are lost.
    EXPECT_EQ(actual.in_view, bad <= kPatternSize / 2) << bad;
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, ResidualKernels, testing::ValuesIn(test::processor_targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace ldso
