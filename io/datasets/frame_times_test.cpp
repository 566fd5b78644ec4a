#include "io/datasets/frame_times.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

class TimesFile : public testing::Test {
 protected:
  FrameTimes read(const std::string& text) {
    write_text(folder_ / "times.txt", text);
    return read_tum_mono_times(folder_ / "times.txt", warnings_);
  }
  std::vector<FrameEntry> match(const std::vector<std::string>& names, const std::string& text) {
    return match_times(names, read(text), warnings_);
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(TimesFile, HasIdTimeAndPerhapsExposure) {
  const FrameTimes times = read("00000 1.5 2.25\n00001 1.6\n");
  ASSERT_EQ(times.entries.size(), 2U);
  EXPECT_EQ(times.entries[0].id, "00000");
  EXPECT_EQ(times.entries[0].timestamp, 1.5);
  EXPECT_EQ(times.entries[0].exposure_ms, 2.25);
  EXPECT_FALSE(times.entries[1].exposure_ms.has_value());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(TimesFile, ImpossibleExposuresAreUnknownWithOneWarning) {
  const FrameTimes times = read("0 0.1 nan\n1 0.2 0\n2 0.3 -3\n3 0.4 inf\n4 0.5 7\n");
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(times.entries[static_cast<std::size_t>(i)].exposure_ms.has_value()) << i;
  EXPECT_EQ(times.entries[4].exposure_ms, 7);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("times.txt:1: 4 exposure times"), std::string::npos) << warnings_[0];
}

TEST_F(TimesFile, BadLinesAreErrors) {
  EXPECT_NE(error_of([&] { read("0 0.1 1\n1\n"); }).find("times.txt:2: has 1 columns"), std::string::npos);
  EXPECT_NE(error_of([&] { read("0 0.1 1\n1 nan 1\n"); }).find("times.txt:2: 'nan' is not finite"), std::string::npos);
  EXPECT_NE(error_of([&] { read("0 0.1 x\n"); }).find("'x' is not a number"), std::string::npos);
}

TEST_F(TimesFile, OfTheSameLengthIsMatchedById) {
  const auto frames = match({"00000.jpg", "00001.jpg"}, "00001 0.2\n00000 0.1\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].timestamp, 0.1);
  EXPECT_EQ(frames[1].timestamp, 0.2);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(TimesFile, OfTheSameLengthWithoutCommonIdsIsMatchedByOrder) {
  const auto frames = match({"left.png", "right.png"}, "00000 0.1\n00001 0.2\n");
  EXPECT_EQ(frames[0].timestamp, 0.1);
  EXPECT_EQ(frames[1].timestamp, 0.2);
}

TEST_F(TimesFile, OfAnotherLengthIsMatchedByIdWithAWarning) {
  const auto frames = match({"f_00001.png", "f_00002.png", "f_00003.png"}, "0 0.0\n1 0.1\n3 0.3\n9 0.9\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].name, "f_00001.png");
  EXPECT_EQ(frames[1].timestamp, 0.3);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("3 images and 4 lines"), std::string::npos) << warnings_[0];
  EXPECT_NE(warnings_[0].find("2 frames"), std::string::npos) << warnings_[0];
}

TEST_F(TimesFile, OfAnotherLengthWithoutCommonIdsIsAnError) {
  const std::string message = error_of([&] { match({"a.png", "b.png", "c.png"}, "0 0.0\n1 0.1\n"); });
  EXPECT_NE(message.find("3 images and 2 lines of times"), std::string::npos) << message;
}

TEST_F(TimesFile, IdsCountedFromZeroForImagesCountedFromOneGoByOrder) {
  for (const int shift : {1, 2}) {
    warnings_.clear();
    std::vector<std::string> names;
    for (int i = 0; i < 5; ++i) names.push_back("0000" + std::to_string(i + shift) + ".png");
    const auto frames = match(names, "0 0.0\n1 0.1\n2 0.2\n3 0.3\n4 0.4\n");
    ASSERT_EQ(frames.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(frames[i].timestamp, 0.1 * static_cast<double>(i));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("counted from " + std::to_string(shift) + ", the ids from 0"), std::string::npos);
  }
}

TEST_F(TimesFile, IdsCountedFromAnotherNumberThatAreNotAsManyAreAnError) {
  const std::string message = error_of([&] { match({"1.png", "2.png", "3.png", "4.png"}, "0 0.0\n1 0.1\n2 0.2\n"); });
  EXPECT_NE(message.find("counted from 1, the ids from 0"), std::string::npos) << message;
  // Each image has its line: nothing is doubtful.
  EXPECT_EQ(match({"1.png", "2.png"}, "0 0.0\n1 0.1\n2 0.2\n")[0].timestamp, 0.1);
}

TEST_F(TimesFile, TimesInOtherUnitsBecomeSeconds) {
  EXPECT_DOUBLE_EQ(read("0 100\n1 133\n2 167\n").entries[1].timestamp, 0.133);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("milliseconds"), std::string::npos) << warnings_[0];
  EXPECT_DOUBLE_EQ(read("0 100000\n1 133000\n2 167000\n").entries[1].timestamp, 0.133);
  EXPECT_DOUBLE_EQ(read("0 1403715273262142976\n1 1403715273312143104\n").entries[1].timestamp, 1403715273.3121431);
  write_text(folder_ / "times.txt", "0\n33000000\n67000000\n");
  EXPECT_DOUBLE_EQ(read_kitti_times(folder_ / "times.txt", warnings_).entries[1].timestamp, 0.033);
}

TEST_F(TimesFile, LongIdsOfNanosecondsMatch) {
  const auto frames = match({"1403715273262142976.png", "1403715273312143104.png"},
                            "1403715273262142976 1403715273.262\n1403715273312143104 1403715273.312\n");
  EXPECT_EQ(frames[1].timestamp, 1403715273.312);
}

TEST_F(TimesFile, KittiTimesGoByOrderOrElseByTheNumberInTheName) {
  write_text(folder_ / "times.txt", "0.0\n0.1\n0.2\n");
  const FrameTimes times = read_kitti_times(folder_ / "times.txt", warnings_);
  const auto excerpt = match_times({"000100.png", "000101.png", "000102.png"}, times, warnings_);
  EXPECT_EQ(excerpt[2].timestamp, 0.2);
  EXPECT_TRUE(warnings_.empty());
  const auto part = match_times({"000001.png", "000002.png"}, times, warnings_);
  EXPECT_EQ(part[0].timestamp, 0.1);
  EXPECT_EQ(warnings_.size(), 1U);
  write_text(folder_ / "times.txt", "0 0.0\n");
  EXPECT_NE(error_of([&] { read_kitti_times(folder_ / "times.txt", warnings_); }).find("times.txt:1"),
            std::string::npos);
}

TEST_F(TimesFile, RateGivesTimes) {
  const auto frames = times_from_rate({"a", "b", "c"}, 25);
  EXPECT_DOUBLE_EQ(frames[2].timestamp, 0.08);
  EXPECT_NE(error_of([&] { times_from_rate({"a"}, 0); }).find("--fps"), std::string::npos);
}

}  // namespace
}  // namespace ldso
