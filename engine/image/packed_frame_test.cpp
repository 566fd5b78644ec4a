#include "image/packed_frame.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

RawFrame ramp(float first, float step) {
  RawFrame raw;
  raw.id = 7;
  raw.timestamp = 1.5;
  raw.exposure_ms = 3.25;
  raw.name = "a.png";
  raw.grey = Image<float>(32, 8);
  for (std::size_t i = 0; i < raw.grey.size(); ++i) raw.grey.data()[i] = first + step * static_cast<float>(i);
  return raw;
}

void expect_same_after_packing(const RawFrame& raw, std::size_t bytes_per_pixel) {
  const PackedFrame packed(raw);
  EXPECT_EQ(packed.bytes(), bytes_per_pixel * raw.grey.size());
  const RawFrame unpacked = packed.unpack();
  EXPECT_EQ(unpacked.id, raw.id);
  EXPECT_EQ(unpacked.timestamp, raw.timestamp);
  EXPECT_EQ(unpacked.exposure_ms, raw.exposure_ms);
  EXPECT_EQ(unpacked.name, raw.name);
  ASSERT_EQ(unpacked.grey.width(), raw.grey.width());
  ASSERT_EQ(unpacked.grey.height(), raw.grey.height());
  for (std::size_t i = 0; i < raw.grey.size(); ++i) ASSERT_EQ(unpacked.grey.data()[i], raw.grey.data()[i]) << i;
}

TEST(PackedFrame, WholeGreyLevelsTakeAByte) { expect_same_after_packing(ramp(0, 1), 1); }

TEST(PackedFrame, LevelsOfSixteenBitsTakeTwo) {
  RawFrame raw = ramp(0, 1);
  for (std::size_t i = 0; i < raw.grey.size(); ++i) {
    raw.grey.data()[i] = static_cast<float>(255 * i) * (1.0f / 257.0f);
  }
  expect_same_after_packing(raw, 2);
}

TEST(PackedFrame, AnythingElseIsKeptAsItIs) {
  expect_same_after_packing(ramp(0.1f, 0.7f), 4);
  expect_same_after_packing(ramp(-3, 1), 4);
  expect_same_after_packing(ramp(200, 1), 4);  // Brighter than any camera says.
}

}  // namespace
}  // namespace ldso
