#include "place/orb_descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

namespace ldso {
namespace {

constexpr int kWidth = 320, kHeight = 240;

/// Texture without flat parts: waves of many directions and lengths; defined everywhere, so it can be turned exactly.
class WaveTexture {
 public:
  WaveTexture() {
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
    };
    for (int i = 0; i < 60; ++i) {
      const double angle = uniform(0, std::numbers::pi), length = uniform(6, 30);
      const double k = 2 * std::numbers::pi / length;
      waves_.push_back({Eigen::Vector2d(std::cos(angle), std::sin(angle)) * k, uniform(0, 2 * std::numbers::pi)});
    }
  }

  double operator()(const Eigen::Vector2d& p) const {
    double value = 0;
    for (const Wave& wave : waves_) value += std::cos(wave.k.dot(p) + wave.phase);
    return std::clamp(120 + 8 * value, 5.0, 250.0);
  }

 private:
  struct Wave {
    Eigen::Vector2d k;
    double phase;
  };
  std::vector<Wave> waves_;
};

const Eigen::Vector2d kCenter(kWidth / 2.0, kHeight / 2.0);

Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle) {
  return {std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y()};
}

/// The texture turned by `angle` about the centre of the image.
Image<Texel> render(double angle) {
  static const WaveTexture kTexture;
  static std::map<double, Image<Texel>> rendered;
  if (rendered.contains(angle)) return rendered[angle];
  Image<Texel> image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      image(x, y) = {static_cast<float>(kTexture(turned(Eigen::Vector2d(x, y) - kCenter, -angle))), 0, 0, 1};
  }
  return rendered[angle] = image;
}

/// Pixels near the centre, which stay inside when the image is turned, and where they go.
std::vector<Eigen::Vector2f> corners(double angle) {
  std::vector<Eigen::Vector2f> list;
  for (int y = -60; y <= 60; y += 15) {
    for (int x = -60; x <= 60; x += 15)
      list.emplace_back((kCenter + turned(Eigen::Vector2d(x, y), angle)).cast<float>());
  }
  return list;
}

double mean_distance(const DescribedCorners& a, const DescribedCorners& b) {
  EXPECT_EQ(a.features.size(), b.features.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.features.size(); ++i)
    sum += hamming_distance(a.features[i].descriptor, b.features[i].descriptor);
  return sum / static_cast<double>(a.features.size());
}

/// How many corners are nearest to themselves among all of the other image.
int recognized(const DescribedCorners& a, const DescribedCorners& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < b.features.size(); ++j) {
      if (hamming_distance(a.features[i].descriptor, b.features[j].descriptor) <
          hamming_distance(a.features[i].descriptor, b.features[nearest].descriptor))
        nearest = j;
    }
    count += nearest == i;
  }
  return count;
}

double angle_difference(double a, double b) { return std::remainder(a - b, 2 * std::numbers::pi); }

TEST(OrbDescriptor, AngleIsTheDirectionToTheCentroid) {
  for (const double angle : {-3.0, -1.7, -0.4, 0.0, 0.9, 2.2, 3.1}) {
    Image<Texel> image(64, 64);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x)
        image(x, y).intensity =
            static_cast<float>(100 + 2.5 * ((x - 32) * std::cos(angle) + (y - 32) * std::sin(angle)));
    }
    const DescribedCorners described = describe(image, std::vector{Eigen::Vector2f(32, 32)});
    ASSERT_EQ(described.features.size(), 1u);
    EXPECT_NEAR(angle_difference(described.features[0].angle, angle), 0, 0.03) << angle;
  }
}

TEST(OrbDescriptor, DescribesTheSamePlaceInATurnedImage) {
  const DescribedCorners upright = describe(render(0), corners(0));
  ASSERT_EQ(upright.features.size(), 81u);
  for (const double angle : {0.3, 1.0, std::numbers::pi / 2, 2.5, -2.0}) {
    const DescribedCorners turned_by = describe(render(angle), corners(angle));
    // Different places differ in 128 bits.
    EXPECT_LT(mean_distance(upright, turned_by), 45) << angle;
    EXPECT_GE(recognized(upright, turned_by), 73) << angle;
    int right_angles = 0;
    for (std::size_t i = 0; i < upright.features.size(); ++i) {
      const double difference = turned_by.features[i].angle - upright.features[i].angle;
      right_angles += std::abs(angle_difference(difference, angle)) < 0.2;
    }
    EXPECT_GE(right_angles, 73) << angle;
  }
}

TEST(OrbDescriptor, BrightnessAndContrastDoNotMatter) {
  const Image<Texel> image = render(0);
  const DescribedCorners original = describe(image, corners(0));
  const auto changed = [&](float factor, float offset) {
    Image<Texel> result = image;
    for (std::size_t i = 0; i < result.size(); ++i)
      result.data()[i].intensity = factor * result.data()[i].intensity + offset;
    return describe(result, corners(0));
  };
  // What is left are the comparisons of nearly equal pixels, which rounding to 8 bits decides.
  EXPECT_LT(mean_distance(original, changed(0.5F, 0)), 20);
  EXPECT_LT(mean_distance(original, changed(0.5F, 60)), 22);
  EXPECT_GE(recognized(original, changed(0.5F, 60)), 78);
  EXPECT_LT(mean_distance(original, changed(0.1F, 0)), 32);
  EXPECT_GE(recognized(original, changed(0.1F, 0)), 75);
}

TEST(OrbDescriptor, LeavesOutCornersAtTheBorder) {
  const float right = kWidth - 1 - kDescriptorMargin, bottom = kHeight - 1 - kDescriptorMargin;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector2f> list{{kDescriptorMargin, kDescriptorMargin},
                                          {kDescriptorMargin - 1, 100},
                                          {right, bottom},
                                          {right + 1, 100},
                                          {100, bottom + 1},
                                          {-5000, 1e9F},
                                          {nan, 100},
                                          {100.4F, 100.6F}};
  const DescribedCorners described = describe(render(0), list);
  EXPECT_EQ(described.corner_index, (std::vector{0, 2, 7}));
  ASSERT_EQ(described.features.size(), 3u);
  EXPECT_EQ(described.features[2].u, 100.4F);
  EXPECT_EQ(described.features[2].v, 100.6F);
}

TEST(OrbDescriptor, DoesNotDependOnTheOtherCorners) {
  const Image<Texel> image = render(0);
  const std::vector<Eigen::Vector2f> all = corners(0);
  const DescribedCorners together = describe(image, all);
  for (std::size_t i = 0; i < all.size(); i += 7) {
    const DescribedCorners alone = describe(image, std::span(all).subspan(i, 1));
    ASSERT_EQ(alone.features.size(), 1u);
    EXPECT_EQ(alone.features[0].descriptor, together.features[i].descriptor);
    EXPECT_EQ(alone.features[0].angle, together.features[i].angle);
  }
}

TEST(OrbDescriptor, NothingToDescribe) {
  EXPECT_TRUE(describe(render(0), {}).features.empty());
  EXPECT_TRUE(describe(Image<Texel>(), std::vector{Eigen::Vector2f(5, 5)}).features.empty());
  EXPECT_TRUE(describe(Image<Texel>(30, 30), std::vector{Eigen::Vector2f(15, 15)}).features.empty());
}

TEST(OrbDescriptor, CopesWithAnyIntensity) {
  Image<Texel> image = render(0);
  const float inf = std::numeric_limits<float>::infinity();
  image(100, 100).intensity = inf;
  image(101, 100).intensity = -inf;
  image(102, 100).intensity = std::numeric_limits<float>::quiet_NaN();
  image(103, 100).intensity = 1e30F;
  EXPECT_EQ(describe(image, std::vector{Eigen::Vector2f(100, 100)}).features.size(), 1u);
}

TEST(OrbDescriptor, HammingDistance) {
  OrbDescriptor a, b;
  EXPECT_EQ(hamming_distance(a, b), 0);
  b.bits = {~0ULL, ~0ULL, ~0ULL, ~0ULL};
  EXPECT_EQ(hamming_distance(a, b), 256);
  a.bits[2] = 1ULL << 63;
  EXPECT_EQ(hamming_distance(a, b), 255);
}

}  // namespace
}  // namespace ldso
