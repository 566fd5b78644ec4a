#include "experiment/jobs/time_left.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

ExperimentJob job(const std::string& sequence, const std::string& variant, const std::string& dataset) {
  ExperimentJob result;
  result.sequence = sequence;
  result.variant = variant;
  result.dataset = dataset;
  return result;
}

TEST(TimeLeft, NearestKindDecides) {
  TimeLeft left;
  EXPECT_FALSE(left.expected(job("a", "corners", "d")).has_value());
  left.learn(job("a", "corners", "d"), 10);
  left.learn(job("a", "corners", "d"), 20);
  left.learn(job("a", "random", "d"), 6);
  left.learn(job("b", "random", "d"), 40);
  left.learn(job("z", "random", "e"), 104);
  EXPECT_DOUBLE_EQ(*left.expected(job("a", "corners", "d")), 15);
  EXPECT_DOUBLE_EQ(*left.expected(job("a", "gradient", "d")), 12);
  EXPECT_DOUBLE_EQ(*left.expected(job("c", "corners", "d")), 19);
  EXPECT_DOUBLE_EQ(*left.expected(job("c", "corners", "f")), 36);
}

TEST(TimeLeft, DurationsAreReadable) {
  EXPECT_EQ(readable_duration(0.2), "0 s");
  EXPECT_EQ(readable_duration(99), "99 s");
  EXPECT_EQ(readable_duration(720), "12 min");
  EXPECT_EQ(readable_duration(12000), "3 h 20 min");
  EXPECT_EQ(readable_duration(187200), "2 d 4 h");
}

}  // namespace
}  // namespace ldso
