#include "io/bags/unpack.h"

#include <gtest/gtest.h>

#include "io/bags/test_bags.h"

namespace ldso {
namespace {

constexpr Packing kAll[] = {Packing::kNone, Packing::kBz2, Packing::kLz4, Packing::kZstd};

/// Compresses to a third or so.
Bytes some_bytes(std::size_t count) {
  Bytes bytes(count);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 29U);
  return bytes;
}

TEST(Unpack, GivesBackWhatWasPacked) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1} << 16, std::size_t{300'000}}) {
    for (const Packing packing : kAll) {
      const Unpacked unpacked = unpack(packing, pack(packing, some_bytes(count)), count);
      EXPECT_EQ(unpacked.problem, "") << static_cast<int>(packing) << " " << count;
      EXPECT_EQ(unpacked.bytes, some_bytes(count));
    }
  }
}

TEST(Unpack, OfDataThatAreCutOffGivesTheirBeginning) {
  const Bytes whole = some_bytes(2'000'000);
  for (const Packing packing : {Packing::kBz2, Packing::kLz4, Packing::kZstd}) {
    Bytes packed = pack(packing, whole);
    packed.resize(packed.size() / 2);
    const Unpacked unpacked = unpack(packing, packed, whole.size());
    EXPECT_NE(unpacked.problem, "");
    ASSERT_GT(unpacked.bytes.size(), whole.size() / 4) << static_cast<int>(packing);
    ASSERT_LT(unpacked.bytes.size(), whole.size());
    EXPECT_TRUE(std::equal(unpacked.bytes.begin(), unpacked.bytes.end(), whole.begin()));
  }
}

TEST(Unpack, TakesNoMoreThanIsAnnounced) {
  for (const Packing packing : kAll) {
    const Unpacked unpacked = unpack(packing, pack(packing, some_bytes(200'000)), 100'000);
    EXPECT_EQ(unpacked.problem, "it is larger than announced");
    EXPECT_LE(unpacked.bytes.size(), 100'000U);
  }
}

TEST(Unpack, DamageIsSaid) {
  for (const Packing packing : {Packing::kBz2, Packing::kLz4, Packing::kZstd}) {
    const Unpacked unpacked = unpack(packing, Bytes(100, 'x'), 1000);
    EXPECT_NE(unpacked.problem.find("damaged"), std::string::npos) << unpacked.problem;
    EXPECT_TRUE(unpacked.bytes.empty());
  }
}

TEST(Unpack, KnowsTheNamesThatBagsUse) {
  EXPECT_EQ(packing_of(""), Packing::kNone);
  EXPECT_EQ(packing_of("none"), Packing::kNone);
  EXPECT_EQ(packing_of("lz4"), Packing::kLz4);
  EXPECT_FALSE(packing_of("xz"));
}

}  // namespace
}  // namespace ldso
