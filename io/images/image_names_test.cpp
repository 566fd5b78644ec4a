#include "io/images/image_names.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

using Names = std::vector<std::string>;

Names sorted_names(Names names) {
  sort_image_names(names);
  return names;
}

/// The order of `expected` is found whatever the order before.
void expect_order(const Names& expected) { EXPECT_EQ(sorted_names({expected.rbegin(), expected.rend()}), expected); }

Names patterns_of(const Names& names) {
  Names patterns;
  for (const ImageFamily& family : image_families(names))
    patterns.push_back(family.pattern + " " + std::to_string(family.count));
  return patterns;
}

TEST(NaturalLess, NumbersCountAsNumbers) {
  EXPECT_TRUE(natural_less("img9.png", "img10.png"));
  EXPECT_FALSE(natural_less("img10.png", "img9.png"));
  EXPECT_TRUE(natural_less("a2b1", "a2b03"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("img01.png", "img1.png"));
  EXPECT_FALSE(natural_less("img1.png", "img01.png"));
  EXPECT_FALSE(natural_less("x.png", "x.png"));
  EXPECT_TRUE(natural_less("99999999999999999999998.png", "99999999999999999999999.png"));
}

TEST(ImageNames, SecondsWithoutTrailingZerosAreInTheOrderOfTime) {
  expect_order({"1305031102.05.png", "1305031102.1.png", "1305031102.15.png", "1305031102.2.png", "1305031103.png",
                "1305031103.03.png"});
  expect_order({"0.0.png", "0.033.png", "0.0667.png", "0.1.png", "9.5.png", "10.25.png"});
  expect_order({"1305031102.10.png", "1305031102.175.png"});
}

TEST(ImageFamilies, PercentSignsInNamesAreNoMarks) {
  const Names names{"%dub/a%d1.png",   "%dub/a%d2.png",   "%20x/cam0_1.png",
                    "%20x/cam0_2.png", "%20x/cam1_1.png", "%20x/cam1_2.png"};
  EXPECT_EQ(patterns_of(names), Names({"%%20x/cam0_%d.png 2", "%%20x/cam1_%d.png 2", "%%dub/a%%d%d.png 2"}));
  for (const ImageFamily& family : image_families(names)) {
    EXPECT_EQ(std::count_if(names.begin(), names.end(),
                            [&](const std::string& name) { return matches_pattern(name, family.pattern); }),
              family.count);
  }
}

TEST(ImageNames, NumbersOfPartsAreNoSeconds) {
  expect_order({"1.1.png", "1.2.png", "1.9.png", "1.10.png", "1.11.png"});
  expect_order({"img9.png", "img10.png"});
  expect_order({"1305031102.000001.png", "1305031102.200000.png"});
}

TEST(ImageNames, OfOneSequenceAreOneFamily) {
  EXPECT_EQ(patterns_of({"img_9.png", "img_10.png"}), Names{"img_%d.png 2"});
  EXPECT_EQ(patterns_of({"1.PNG", "2.png"}), Names{"%d.png 2"});
  EXPECT_EQ(patterns_of({"a.png", "b.png"}), Names{"*.png 2"});
  EXPECT_EQ(patterns_of({"1305031102.1.png", "1305031103.png"}), Names{"*.png 2"});
  EXPECT_EQ(patterns_of({"12-01-58.png", "12-01-59.png", "12-02-00.png"}), Names{"%d-%d-%d.png 3"});
  EXPECT_EQ(patterns_of({"0_001.png", "1_002.png", "2_003.png"}), Names{"%d_%d.png 3"});
}

TEST(ImageNames, OfSeveralKindsAreSeveralFamilies) {
  EXPECT_EQ(patterns_of({"frame-1.color.png", "frame-1.depth.png", "frame-2.color.png", "frame-2.depth.png"}),
            (Names{"frame-%d.color.png 2", "frame-%d.depth.png 2"}));
  EXPECT_EQ(patterns_of({"left_1.png", "right_1.png"}), (Names{"left_%d.png 1", "right_%d.png 1"}));
  EXPECT_EQ(patterns_of({"1.png", "1.jpg"}), (Names{"%d.jpg 1", "%d.png 1"}));
  EXPECT_EQ(patterns_of({"cam0/1.png", "cam1/1.png"}), (Names{"cam0/%d.png 1", "cam1/%d.png 1"}));
  EXPECT_EQ(patterns_of({"cam0_1.png", "cam1_1.png", "cam0_2.png", "cam1_2.png"}),
            (Names{"cam0_%d.png 2", "cam1_%d.png 2"}));
}

TEST(ImageNames, FamilyPatternsMatchTheirOwnAlone) {
  const Names names{"frame-1.png", "frame-1.color.png", "left_1.png", "1.png", "1.jpg", "a1b2.png"};
  for (const ImageFamily& family : image_families(names)) {
    const auto matches = [&](const std::string& name) { return matches_pattern(name, family.pattern); };
    EXPECT_EQ(std::count_if(names.begin(), names.end(), matches), family.count) << family.pattern;
  }
}

TEST(ImageNames, PatternsKnowNumbersAndAnyText) {
  EXPECT_TRUE(matches_pattern("frame-000012.png", "frame-%06d.png"));
  EXPECT_FALSE(matches_pattern("frame-1.color.png", "frame-%d.png"));
  EXPECT_FALSE(matches_pattern("frame-.png", "frame-%d.png"));
  EXPECT_TRUE(matches_pattern("frame-1.color.PNG", "frame-*.png"));
  EXPECT_TRUE(matches_pattern("cam0/7.png", "?.png"));
  EXPECT_TRUE(matches_pattern("cam0/7.png", "cam0/*"));
  EXPECT_FALSE(matches_pattern("cam1/7.png", "cam0/*"));
  EXPECT_TRUE(matches_pattern("100%.png", "100%.png"));
  std::string stars(3000, '*');
  stars.back() = 'b';
  EXPECT_FALSE(matches_pattern(std::string(3000, 'a'), stars));
}

TEST(ImageNames, AreChosenByAPatternOrAllAlike) {
  const Names both{"left_1.png", "left_2.png", "right_1.png"};
  EXPECT_EQ(choose_images(both, "left_%d.png", "images").size(), 2U);
  EXPECT_EQ(choose_images(both, "*", "images").size(), 3U);
  EXPECT_EQ(choose_images({"left_1.png"}, "", "images").size(), 1U);
  const std::string several = error_of([&] { choose_images(both, "", "images"); });
  EXPECT_NE(several.find("left_%d.png (2), right_%d.png (1)"), std::string::npos) << several;
  EXPECT_NE(several.find("--pattern 'left_%d.png'"), std::string::npos) << several;
  const std::string none = error_of([&] { choose_images(both, "middle_%d.png", "images"); });
  EXPECT_NE(none.find("right_%d.png (1)"), std::string::npos) << none;
}

TEST(ImageNames, ThatSayNothingAreTakenAsTheyAre) {
  Names hashes;
  for (char c = 'a'; c < 'z'; ++c) hashes.push_back(std::string(1, c) + "7.png");
  EXPECT_EQ(choose_images(hashes, "", "images").size(), hashes.size());
}

}  // namespace
}  // namespace ldso
