#include "io/datasets/time_unit.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

std::vector<double> regular_times(double gap, double first = 0) {
  std::vector<double> times;
  for (int i = 0; i < 10; ++i) times.push_back(first + gap * i);
  return times;
}

TEST(TimeUnit, IsToldByTheGap) {
  for (const double fps : {0.25, 1.0, 15.0, 30.0, 60.0, 199.0}) {
    EXPECT_EQ(seconds_per_unit(regular_times(1 / fps)), 1) << fps;
    EXPECT_EQ(seconds_per_unit(regular_times(1e3 / fps)), 1e-3) << fps;
    EXPECT_EQ(seconds_per_unit(regular_times(1e6 / fps)), 1e-6) << fps;
    EXPECT_EQ(seconds_per_unit(regular_times(1e9 / fps, 1.4e18)), 1e-9) << fps;
  }
  EXPECT_EQ(seconds_per_unit({}), 1);
  EXPECT_EQ(seconds_per_unit({1e18}), 1);
  EXPECT_EQ(seconds_per_unit(regular_times(1e300)), 1);
}

TEST(TimeUnit, OfSequencesPlayedBackwardsOrWithGapsIsTheSame) {
  EXPECT_EQ(seconds_per_unit(regular_times(-33.3)), 1e-3);
  EXPECT_EQ(seconds_per_unit({0, 0.033, 0.067, 0.1, 900, 900.033}), 1);
}

TEST(TimeUnit, TimesBecomeSecondsAndThatIsSaid) {
  std::vector<double> times = regular_times(33, 100);
  std::vector<std::string> warnings;
  convert_to_seconds(times, "times.txt", warnings);
  EXPECT_DOUBLE_EQ(times[2], 0.166);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("milliseconds, since they are 33 apart"), std::string::npos) << warnings[0];
}

TEST(TimeUnit, SecondsStayWithoutAWord) {
  std::vector<double> times = regular_times(0.1, 1305031102);
  const std::vector<double> before = times;
  std::vector<std::string> warnings;
  convert_to_seconds(times, "times.txt", warnings);
  EXPECT_EQ(times, before);
  EXPECT_TRUE(warnings.empty());
}

TEST(TimeUnit, FrameNumbersAreDoubted) {
  std::vector<double> times = regular_times(1, 7);
  std::vector<std::string> warnings;
  convert_to_seconds(times, "times.txt", warnings);
  EXPECT_EQ(times[1], 8);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("frame numbers"), std::string::npos);
  EXPECT_FALSE(look_like_frame_numbers(regular_times(0.5)));
  EXPECT_FALSE(look_like_frame_numbers({0, 1}));
}

}  // namespace
}  // namespace ldso
