#include "terminal/option_checks.h"

#include <gtest/gtest.h>

#include <string>

namespace ldso {
namespace {

/// What the validator makes of a value, or says of it.
std::string result_of(const CLI::Validator& validator, std::string value) {
  const std::string complaint = validator(value);
  return complaint.empty() ? value : complaint;
}

TEST(OptionChecks, FrameRatesMayBeFractions) {
  EXPECT_EQ(result_of(frame_rate(), "30"), "30");
  EXPECT_EQ(result_of(frame_rate(), "29.97"), "29.97");
  EXPECT_EQ(result_of(frame_rate(), "30000/1001").substr(0, 10), "29.9700299");
  for (const char* bad : {"", "0", "-30", "30/0", "30/", "/2", "thirty", "30/1/1", "inf", "nan"})
    EXPECT_NE(result_of(frame_rate(), bad).find("is no frame rate"), std::string::npos) << bad;
}

TEST(OptionChecks, RangesAreToldInFewWords) {
  EXPECT_EQ(result_of(positive_number(), "0.5"), "0.5");
  EXPECT_EQ(result_of(positive_number(), "0"), "'0' is not a number above 0");
  EXPECT_EQ(result_of(positive_number(), "x"), "'x' is not a number above 0");
  EXPECT_EQ(result_of(number_from_zero(), "0"), "0");
  EXPECT_EQ(result_of(number_from_zero(), "-1"), "'-1' is not a number of 0 or more");
}

}  // namespace
}  // namespace ldso
