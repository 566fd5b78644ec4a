#include "place/orb_on_grey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "place/orb_descriptor.h"

namespace ldso {
namespace {

TEST(OrbOnGrey, ImagesAreRootsOfIrradiance) {
  Image<Texel> image(5, 1);
  const std::vector<float> values{0, 1, 64, 255, std::numeric_limits<float>::quiet_NaN()};
  for (int x = 0; x < image.width(); ++x) image(x, 0).intensity = values[x];
  const cv::Mat grey = to_8_bit(image);
  for (int x = 0; x < 4; ++x) EXPECT_NEAR(grey.at<std::uint8_t>(0, x), std::sqrt(255.0 * values[x]), 1.5) << values[x];
  EXPECT_EQ(grey.at<std::uint8_t>(0, 4), 0);
}

TEST(OrbOnGrey, APatchHasRoomWithinTheMargin) {
  constexpr float kMargin = kDescriptorMargin;
  EXPECT_TRUE(has_room({kMargin, kMargin}, 100, 80));
  EXPECT_TRUE(has_room({99 - kMargin, 79 - kMargin}, 100, 80));
  EXPECT_FALSE(has_room({kMargin - 0.5F, 40}, 100, 80));
  EXPECT_FALSE(has_room({50, 79.5F - kMargin}, 100, 80));
  EXPECT_FALSE(has_room({std::numeric_limits<float>::quiet_NaN(), 40}, 100, 80));
}

TEST(OrbOnGrey, FeaturesGetTheBitsOfTheSamePixels) {
  cv::Mat grey(60, 80, CV_8U);
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x)
      grey.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>((x * x + 7 * y * x) % 251);
  }
  std::vector<Feature> features{{{}, 30, 30, 0}, {{}, 50, 35, 0}, {{}, 30.2F, 29.8F, 0}};
  describe_on(grey, features);
  EXPECT_EQ(features[0].descriptor, features[2].descriptor) << "pixels are whole";
  EXPECT_EQ(features[0].angle, features[2].angle);
  EXPECT_GT(hamming_distance(features[0].descriptor, features[1].descriptor), 60);
}

}  // namespace
}  // namespace ldso
