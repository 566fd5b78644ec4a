#include "io/images/april_tag.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Tags of `cell` pixels a cell, the first corner of each black square at pixel `at` (its edge, half a pixel before).
Image<float> picture_of(const std::string& family, int id, int cell, int at) {
  const Image<std::uint8_t> tag = draw_april_tag(family, id);
  Image<float> image(320, 240, 230.F);
  for (int y = 0; y < tag.height() * cell; ++y) {
    for (int x = 0; x < tag.width() * cell; ++x) image(at + x, at + y) = 20.F + 0.8F * tag(x / cell, y / cell);
  }
  return image;
}

TEST(AprilTag, IsFoundWithItsCorners) {
  for (const char* family : {"16h5", "25h9", "36h10", "36h11"}) {
    const std::vector<SeenTag> seen = find_april_tags(picture_of(family, 7, 10, 50).view(), family);
    ASSERT_EQ(seen.size(), 1u) << family;
    EXPECT_EQ(seen[0].id, 7);
    const double side = 10.0 * draw_april_tag(family, 7).width();
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR((seen[0].corners[i] - seen[0].corners[(i + 1) % 4]).norm(), side, 0.3) << family;
      EXPECT_NEAR(std::min(seen[0].corners[i].x() - 49.5, 49.5 + side - seen[0].corners[i].x()), 0, 0.3);
    }
  }
}

TEST(AprilTag, OfAnotherFamilyIsNone) {
  EXPECT_TRUE(find_april_tags(picture_of("36h11", 7, 10, 50).view(), "16h5").empty());
}

TEST(AprilTag, ReadsFamilyIdAndSize) {
  const AprilTag tag = parse_april_tag("tag36h11:3:0.16", "--scale-tag");
  EXPECT_EQ(tag.family, "36h11");
  EXPECT_EQ(tag.id, 3);
  EXPECT_EQ(tag.metres, 0.16);
  for (const char* bad : {"", "36h11", "36h11:3", "36h11:x:0.1", "36h11:3:0", "36h11:3:-1", "36h11:3:nan", "36h11:3:1m",
                          "37h11:3:0.1", "36h11:587:0.1", "36h11:-1:0.1", "::"}) {
    EXPECT_THROW(parse_april_tag(bad, "--scale-tag"), Error) << bad;
  }
}

}  // namespace
}  // namespace ldso
