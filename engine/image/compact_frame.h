#pragma once

// A prepared frame that waits, in a fifth of its memory: without what can be computed again from it.

#include <cstdint>
#include <vector>

#include "image/frame.h"
#include "ldso/image.h"

namespace ldso {

class CompactFrame {
 public:
  explicit CompactFrame(const PreparedFrame& frame);

  /// The frame it was made of, bit for bit.
  PreparedFrame unpack() const;

  std::int64_t id() const { return frame_.id; }

 private:
  PreparedFrame frame_;                   ///< Without its pyramid.
  Image<float> intensities_;              ///< Of full resolution: those of coarser levels are their means.
  std::vector<std::vector<bool>> valid_;  ///< Of each level, whether a texel may be used.
};

}  // namespace ldso
