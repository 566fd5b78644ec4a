#pragma once

// Choice of the pixels of a keyframe that become candidate points: one interface, three strategies
// (LDSO III-B; DSO section 3.2).

#include <cstdint>
#include <memory>
#include <vector>

#include "image/frame.h"
#include "ldso/settings.h"

namespace ldso {

/// Pixels nearer than this to the border of a level are never selected [px].
inline constexpr int kSelectionMargin = 4;
/// All texels within this distance (a square of 5x5, the footprint of the residual pattern) must be valid [px].
inline constexpr int kSelectionClearance = 2;

/// A selected pixel, in pixels of the level it was selected on (level 0 for PointSelector).
struct SelectedPixel {
  int x = 0;
  int y = 0;
  bool is_corner = false;    ///< Repeatable: worth a descriptor for loop closing.
  float gradient_scale = 1;  ///< 1, 2 or 4: the block scale it came from; larger means weaker texture.

  friend bool operator==(const SelectedPixel&, const SelectedPixel&) = default;
};

/// A strategy. The result depends on the arguments and the settings alone, not on earlier calls.
/// One object may be used by one thread at a time.
class PointSelector {
 public:
  virtual ~PointSelector() = default;

  /// At most `wanted` distinct pixels of level 0, in a fixed order, corners first. Fewer only where the
  /// image has too little texture. `frame_id` varies the random choices from frame to frame.
  /// Throws Error if the pyramid has no pixels.
  virtual std::vector<SelectedPixel> select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) = 0;
};

/// Throws Error if the pyramid has no pixels.
void check_pyramid(const ImagePyramid& pyramid, std::int64_t frame_id);

/// Throws Error if a setting is out of range.
std::unique_ptr<PointSelector> make_point_selector(const SelectionSettings& settings);

/// Gradient selection on one pyramid level of any size, for the initializer: at most `wanted` distinct
/// pixels of `level`. The wider block scales look at the same level with lowered thresholds.
std::vector<SelectedPixel> select_gradient_pixels(const Image<Texel>& level, int wanted, std::uint64_t seed,
                                                  const SelectionSettings& settings = {});

}  // namespace ldso
