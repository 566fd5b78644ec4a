#include "io/datasets/sequence_images.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

/// A folder of images of 16 bits whose values are `base` plus those of test_frame().
class DeepImages : public testing::Test {
 protected:
  void write(int index, int base) {
    Image<std::uint16_t> image(kTestWidth, kTestHeight);
    for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = static_cast<std::uint16_t>(base);
    image(0, 0) = 0;
    write_png(folder_ / ("images/" + std::to_string(index) + ".png"), image.view());
  }
  std::unique_ptr<Dataset> open(const std::vector<int>& values) {
    std::filesystem::create_directories(folder_ / "images");
    write_text(folder_ / "camera.txt", kTestCamera);
    for (std::size_t i = 0; i < values.size(); ++i) write(static_cast<int>(i), values[i]);
    return open_dataset(folder_.path(), {.fps = 10});
  }

  TemporaryFolder folder_;
};

TEST_F(DeepImages, OfFewerBitsAreScaledByThoseThatAreUsed) {
  for (const int bits : {10, 12, 14}) {
    const int white = (1 << bits) - 1;
    const auto dataset = open({white / 8, white, white / 2});
    EXPECT_FLOAT_EQ(dataset->read(1).grey(5, 5), 255) << bits;
    EXPECT_NEAR(dataset->read(0).grey(5, 5), 255.0 / 8, 0.3) << bits;
    ASSERT_EQ(dataset->warnings().size(), 1U);
    EXPECT_NE(dataset->warnings()[0].find(std::to_string(bits) + " bits of a camera"), std::string::npos)
        << dataset->warnings()[0];
  }
}

TEST_F(DeepImages, OfAllBitsAreScaledByThem) {
  const auto dataset = open({257, 65535, 257 * 100});
  EXPECT_FLOAT_EQ(dataset->read(1).grey(5, 5), 255);
  EXPECT_FLOAT_EQ(dataset->read(2).grey(5, 5), 100);
  EXPECT_TRUE(dataset->warnings().empty());
}

TEST_F(DeepImages, BlackOnesSayNothing) { EXPECT_TRUE(open({0, 0, 0})->warnings().empty()); }

}  // namespace
}  // namespace ldso
