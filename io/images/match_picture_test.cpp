#include "io/images/match_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace ldso {
namespace {

constexpr int kWidth = 80, kHeight = 60;

Image<Rgb> draw(const std::vector<PictureMatch>& matches, const std::string& caption = {}) {
  const Image<float> left(kWidth, kHeight, 40.F), right(kWidth, kHeight, 90.F);
  return draw_matches(left.view(), right.view(), matches, caption);
}

bool is_grey(const Rgb& p) { return p[0] == p[1] && p[1] == p[2]; }

/// How far a pixel is from grey.
int colourfulness(const Rgb& p) {
  return *std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end());
}

TEST(MatchPicture, HasTheImagesSideBySide) {
  Image<float> left(7, 5, 10.4F), right(9, 3, 300.F);
  left(2, 4) = -3;
  const Image<Rgb> picture = draw_matches(left.view(), right.view(), {}, "");
  ASSERT_EQ(picture.width(), 16);
  ASSERT_EQ(picture.height(), 5);
  EXPECT_EQ(picture(6, 0), (Rgb{10, 10, 10}));
  EXPECT_EQ(picture(2, 4), (Rgb{0, 0, 0}));
  EXPECT_EQ(picture(7, 2), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture(7, 3), (Rgb{0, 0, 0})) << "below the lower image";
}

TEST(MatchPicture, CirclesAreAroundThePoints) {
  const Image<Rgb> picture = draw({{{20, 30}, {50, 30}}});
  for (const int centre : {20, kWidth + 50}) {
    for (const int side : {-4, 4}) {  // above and below, where no line is
      EXPECT_GT(colourfulness(picture(centre, 30 + side)), 100) << centre << " " << side;
    }
    EXPECT_TRUE(is_grey(picture(centre, 30 - 8)));
    EXPECT_TRUE(is_grey(picture(centre, 30 + 8)));
    EXPECT_TRUE(is_grey(picture(centre, 30 - 2))) << "a circle, not a disc";
  }
}

TEST(MatchPicture, ALineJoinsThem) {
  const Image<Rgb> picture = draw({{{20, 10}, {40, 50}}});  // from (20, 10) to (120, 50)
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const int x = static_cast<int>(20 + 100 * share), y = static_cast<int>(10 + 40 * share);
    EXPECT_GT(colourfulness(picture(x, y)), 100) << x << " " << y;
    EXPECT_TRUE(is_grey(picture(x, y - 6))) << "the line is thin";
    EXPECT_TRUE(is_grey(picture(x, y + 6))) << "the line is thin";
  }
}

TEST(MatchPicture, TheColourTellsTheColumn) {
  EXPECT_EQ(match_colour(0, 101), (Rgb{255, 0, 0}));
  EXPECT_EQ(match_colour(50, 101), (Rgb{0, 255, 0}));
  EXPECT_EQ(match_colour(100, 101), (Rgb{0, 0, 255}));
  EXPECT_EQ(match_colour(-5, 101), match_colour(0, 101));
  EXPECT_EQ(match_colour(500, 101), match_colour(100, 101));
  const Image<Rgb> picture = draw({{{0, 10}, {70, 10}}, {{79, 40}, {10, 40}}});
  EXPECT_GT(picture(40, 10)[0], picture(40, 10)[2] + 100) << "red";
  EXPECT_GT(picture(kWidth + 5, 40)[2], picture(kWidth + 5, 40)[0] + 100) << "blue";
}

TEST(MatchPicture, TheCaptionIsBelowAndFits) {
  for (const std::string& caption : {std::string("short"), std::string(200, 'W')}) {
    const Image<Rgb> picture = draw({}, caption);
    ASSERT_EQ(picture.height(), kHeight + caption_height(caption));
    ASSERT_EQ(picture.width(), 2 * kWidth);
    int bright = 0;
    for (int y = kHeight; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) bright += picture(x, y)[0] > 60;
      EXPECT_EQ(picture(picture.width() - 1, y)[0], 0) << "the last letter is cut off";
    }
    EXPECT_GT(bright, 10);
    EXPECT_EQ(picture(5, kHeight - 1), (Rgb{40, 40, 40})) << "the caption covers no image";
  }
}

TEST(MatchPicture, APointInOneImageOnlyIsACrossThere) {
  const Image<Rgb> picture = draw({{{kWidth + 20, 30}, {50, 30}}, {{15, 20}, {30, -4}}});
  for (const Eigen::Vector2i& centre : {Eigen::Vector2i(kWidth + 50, 30), Eigen::Vector2i(15, 20)}) {
    const Rgb pixel = picture(centre.x(), centre.y());
    EXPECT_GT(pixel[0], 200);
    EXPECT_LT(pixel[1], 60);
    EXPECT_GT(pixel[2], 200) << "magenta";
    EXPECT_TRUE(is_grey(picture(centre.x() - 7, centre.y()))) << "no line leads away";
    EXPECT_TRUE(is_grey(picture(centre.x() + 7, centre.y())));
  }
  EXPECT_TRUE(is_grey(picture(kWidth + 20, 30))) << "a column beyond the left image is none of the right one";
}

TEST(MatchPicture, PointsThatAreNowhereDoNoHarm) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<PictureMatch> matches{
      {{-20, 5}, {30, 1e30F}}, {{infinity, 0}, {std::numeric_limits<float>::quiet_NaN(), 3}}, {{20, 30}, {50, 30}}};
  const Image<Rgb> picture = draw(matches), without = draw({matches.back()});
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) ASSERT_EQ(picture(x, y), without(x, y)) << x << " " << y;
  }
}

}  // namespace
}  // namespace ldso
