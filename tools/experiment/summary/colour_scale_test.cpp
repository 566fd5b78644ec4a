#include "experiment/summary/colour_scale.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace ldso {
namespace {

/// Relative luminance (without gamma: order is all that counts).
double brightness(const std::string& colour) {
  const auto part = [&](std::size_t at) { return std::strtol(colour.substr(at, 2).c_str(), nullptr, 16); };
  return 0.2126 * static_cast<double>(part(1)) + 0.7152 * static_cast<double>(part(3)) +
         0.0722 * static_cast<double>(part(5));
}

TEST(Viridis, GetsBrighterThroughout) {
  EXPECT_EQ(viridis(0), "#440154");
  EXPECT_EQ(viridis(1), "#fde725");
  EXPECT_EQ(viridis(-5), viridis(0));
  EXPECT_EQ(viridis(7), viridis(1));
  for (int i = 0; i < 50; ++i) EXPECT_LT(brightness(viridis(i / 50.0)), brightness(viridis((i + 1) / 50.0)));
}

TEST(ErrorColours, EndAtRoundNumbersAroundTheErrors) {
  const ErrorColours colours({0.3, 0.07, 4.1, std::numeric_limits<double>::infinity(), 0});
  EXPECT_DOUBLE_EQ(colours.low(), 0.05);
  EXPECT_DOUBLE_EQ(colours.high(), 5);
  EXPECT_EQ(colours.colour(0.05), viridis(0));
  EXPECT_EQ(colours.colour(5), viridis(1));
  EXPECT_EQ(colours.colour(0.5), viridis(0.5));  // In the middle by its logarithm.
  EXPECT_EQ(colours.colour(0), viridis(0));
}

TEST(ErrorColours, SpanThreeDecadesAtMost) {
  const ErrorColours colours({1e-9, 1, 2});
  EXPECT_DOUBLE_EQ(colours.high(), 2);
  EXPECT_NEAR(colours.low(), 0.002, 1e-12);
}

TEST(ErrorColours, ExistWithoutErrorsAndForOne) {
  EXPECT_LT(ErrorColours({}).low(), ErrorColours({}).high());
  const ErrorColours one({1});
  EXPECT_LT(one.low(), one.high());
}

TEST(ErrorColours, LegendHasTicksAndLabel) {
  const std::string svg = ErrorColours({0.11, 0.9}).legend({0, 0, 20, 200}, "ATE [m]");
  EXPECT_NE(svg.find(">ATE [m]<"), std::string::npos);
  for (const char* tick : {">0.1<", ">0.2<", ">0.5<", ">1<"}) EXPECT_NE(svg.find(tick), std::string::npos) << tick;
}

}  // namespace
}  // namespace ldso
