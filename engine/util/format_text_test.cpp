#include "util/format_text.h"

#include <gtest/gtest.h>

#include <string>

namespace ldso {
namespace {

TEST(FormatTextTest, PrintsLikePrintf) {
  EXPECT_EQ(format_text("%d of %.2f %s", 3, 4.5, "px"), "3 of 4.50 px");
  EXPECT_EQ(format_text("%%"), "%");
}

TEST(FormatTextTest, TextsMayBeOfAnyLength) {
  for (const std::size_t length : {0, 254, 255, 256, 257, 1000}) {
    const std::string text(length, 'x');
    EXPECT_EQ(format_text("%s%d", text.c_str(), 7), text + "7");
  }
}

TEST(FormatTextTest, LeavesFiguresOut) {
  EXPECT_EQ(without_numbers("inliers: 12.5 (at least -20)"), without_numbers("inliers: 7 (at least 20)"));
  EXPECT_NE(without_numbers("inliers: 12"), without_numbers("matches: 12"));
}

}  // namespace
}  // namespace ldso
