#include "place/scaled_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "place/orb_descriptor.h"

namespace ldso {
namespace {

constexpr int kSide = 320;
constexpr double kCenter = (kSide - 1) / 2.0;

/// Squares of many sizes, somewhat smoothed: a value of the plane, whatever the scale at which it is drawn.
double squares(double x, double y) {
  double value = 0;
  for (int size = 8; size <= 64; size *= 2) {
    const auto column = static_cast<std::uint32_t>(static_cast<int>(std::floor(x / size)) + 1000);
    const auto row = static_cast<std::uint32_t>(static_cast<int>(std::floor(y / size)) + 1000);
    std::uint32_t h = column * 374761393U + row * 668265263U + static_cast<std::uint32_t>(size) * 2246822519U;
    h = (h ^ (h >> 13U)) * 1274126177U;
    value += static_cast<double>((h >> 16U) % 256) / 4;
  }
  return value;
}

/// The middle of the plane, magnified. Each pixel is the mean of what it covers.
Image<Texel> magnified(double zoom) {
  constexpr int kSteps = 4;
  Image<Texel> image(kSide, kSide);
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      double sum = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double du = (i % kSteps + 0.5) / kSteps - 0.5, dv = (i / kSteps + 0.5) / kSteps - 0.5;
        sum += squares((u + du - kCenter) / zoom, (v + dv - kCenter) / zoom);
      }
      image(u, v) = {static_cast<float>(sum / (kSteps * kSteps)), 0, 0, 1};
    }
  }
  return image;
}

/// Features whose most similar one in the other image lies where the same place is.
int recognized(const std::vector<ScaledFeature>& plain, const std::vector<ScaledFeature>& zoomed, double zoom) {
  int count = 0;
  for (const ScaledFeature& feature : plain) {
    const auto nearest =
        std::min_element(zoomed.begin(), zoomed.end(), [&](const ScaledFeature& a, const ScaledFeature& b) {
          return hamming_distance(a.feature.descriptor, feature.feature.descriptor) <
                 hamming_distance(b.feature.descriptor, feature.feature.descriptor);
        });
    const double u = kCenter + zoom * (feature.feature.u - kCenter), v = kCenter + zoom * (feature.feature.v - kCenter);
    count += std::hypot(nearest->feature.u - u, nearest->feature.v - v) < 3 * zoom / feature.scale;
  }
  return count;
}

TEST(ScaledFeatures, RecognizeWhatHasBecomeLarger) {
  const std::vector<ScaledFeature> plain = find_scaled_features(magnified(1));
  ASSERT_GT(plain.size(), 300U);
  for (const double zoom : {1.25, 1.6, 2.0}) {
    const std::vector<ScaledFeature> zoomed = find_scaled_features(magnified(zoom));
    // Of those that are still in the image.
    const double visible = static_cast<double>(plain.size()) / (zoom * zoom);
    EXPECT_GT(recognized(plain, zoomed, zoom), 0.25 * visible) << zoom;
  }
}

TEST(ScaledFeatures, AreSoughtOnEachScale) {
  const std::vector<ScaledFeature> features = find_scaled_features(magnified(1));
  for (const double scale : {1.0, 0.8, 0.64, 0.512, 0.41, 0.328, 0.262}) {
    EXPECT_TRUE(std::any_of(features.begin(), features.end(), [&](const ScaledFeature& feature) {
      return std::abs(feature.scale - scale) < 0.01;
    })) << scale;
  }
  for (const ScaledFeature& feature : features) {
    EXPECT_GE(feature.feature.u, kDescriptorMargin - 1);
    EXPECT_LE(feature.feature.v, kSide - kDescriptorMargin);
  }
}

TEST(ScaledFeatures, AreNoneWithoutRoomOrTexture) {
  EXPECT_TRUE(find_scaled_features(Image<Texel>(2 * kDescriptorMargin, 30, Texel{})).empty());
  EXPECT_TRUE(find_scaled_features(Image<Texel>(200, 100, Texel{90, 0, 0, 1})).empty());
}

}  // namespace
}  // namespace ldso
