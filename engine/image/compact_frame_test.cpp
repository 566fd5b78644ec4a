#include "image/compact_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "image/masked_image.h"
#include "image/pyramid.h"

namespace ldso {
namespace {

// Texture with holes of all kinds: single pixels, a block, at the border, and a marked zero.
PreparedFrame frame_with_holes() {
  constexpr int kWidth = 203, kHeight = 151;
  MaskedImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float value =
          100.0f + 60.0f * std::sin(0.3f * static_cast<float>(x)) * std::cos(0.17f * static_cast<float>(y));
      const bool is_hole = (x * 7 + y * 13) % 97 == 0 || (x > 50 && x < 70 && y > 20 && y < 33) || x + y < 9;
      image.view().row(y)[x] = is_hole ? mark_invalid(x % 2 == 0 ? value : 0.0f) : value;
    }
  }
  PreparedFrame frame;
  frame.id = 12;
  frame.timestamp = 3.25;
  frame.exposure_ms = 7.5;
  frame.exposure_known = true;
  frame.pyramid = build_pyramid(image.view());
  return frame;
}

TEST(CompactFrame, IsTheSameAfterwards) {
  const PreparedFrame frame = frame_with_holes();
  const CompactFrame compact(frame);
  EXPECT_EQ(compact.id(), 12);
  const PreparedFrame again = compact.unpack();
  EXPECT_EQ(again.id, frame.id);
  EXPECT_EQ(again.timestamp, frame.timestamp);
  EXPECT_EQ(again.exposure_ms, frame.exposure_ms);
  EXPECT_EQ(again.exposure_known, frame.exposure_known);
  ASSERT_EQ(again.pyramid.levels.size(), frame.pyramid.levels.size());
  ASSERT_GT(frame.pyramid.levels.size(), 1U);
  for (std::size_t level = 0; level < frame.pyramid.levels.size(); ++level) {
    const Image<Texel>&before = frame.pyramid.levels[level], &after = again.pyramid.levels[level];
    ASSERT_EQ(after.width(), before.width());
    ASSERT_EQ(after.height(), before.height());
    EXPECT_EQ(std::memcmp(after.data(), before.data(), before.size() * sizeof(Texel)), 0) << "level " << level;
  }
}

}  // namespace
}  // namespace ldso
