#include "util/hash.h"

#include <gtest/gtest.h>

#include <string_view>

namespace ldso {
namespace {

TEST(Hash, IsSplitMix64) {
  // The first two numbers of the generator whose state is 0.
  EXPECT_EQ(hash_of(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(hash_of(kSplitMixStep), 0x6e789e6aa1b965f4ULL);
}

TEST(Hash, OrderOfKeysCounts) {
  EXPECT_NE(hash_of(1, 2), hash_of(2, 1));
  EXPECT_EQ(hash_of(1, 2, 3), hash_of(hash_of(1, 2), 3));
  static_assert(hash_of(1, 2) == hash_of(hash_of(1) ^ 2));
}

TEST(Hash, NumbersAreUniform) {
  double sum = 0;
  int counts[3] = {};
  constexpr int kCount = 30000;
  for (int i = 0; i < kCount; ++i) {
    const double x = unit_interval(hash_of(i));
    ASSERT_TRUE(x >= 0 && x < 1);
    ASSERT_NEAR(unit_interval_float(hash_of(i)), x, 1e-7);
    sum += x;
    ++counts[uniform_index(hash_of(i), 3)];
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.01);
  for (const int count : counts) EXPECT_NEAR(count, kCount / 3, 300);
}

TEST(Checksum, IsFnv1a) {
  const auto of = [](std::string_view text) {
    Checksum checksum;
    for (const char c : text) checksum.add(static_cast<std::uint8_t>(c));
    return checksum.value();
  };
  EXPECT_EQ(of(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(of("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(of("foobar"), 0x85944171f73967e8ULL);
  Checksum number;
  number.add(1.0);  // 0x3ff0000000000000
  EXPECT_EQ(number.value(), of(std::string_view("\0\0\0\0\0\0\xf0\x3f", 8)));
}

}  // namespace
}  // namespace ldso
