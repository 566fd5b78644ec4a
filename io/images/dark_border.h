#pragma once

// Idea: where an image is black in every frame and up to its edge, the lens or the player shows nothing: the corners
// round the circle of an endoscope or a fisheye, the bars of a film. What is there is no scene, and its edge, which
// stays where it is while the camera moves, must not be tracked.

#include <cstdint>

#include "ldso/image.h"

namespace ldso {

enum class DarkBorderKind { kNone, kBars, kRound };

struct DarkBorder {
  DarkBorderKind kind = DarkBorderKind::kNone;
  /// Of the size of the images: 255 where nothing is to be used, the border and a margin of a few pixels along it; else
  /// 0. Empty if there is no border.
  Image<std::uint8_t> mask;
  double share = 0;  ///< Of the pixels that are masked.
};

/// `brightest`: of each pixel the largest grey level (0..255) over frames that show different things. Only a border of
/// the shape of bars or of what lies outside of a circle counts: a scene may have dark corners as well.
DarkBorder find_dark_border(ImageView<const float> brightest);

}  // namespace ldso
