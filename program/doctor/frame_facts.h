#pragma once
// What a single image says of itself, and what it says beside the one before it.

#include "ldso/image.h"

namespace ldso {

struct FrameFacts {
  int index = 0;            ///< Of the frame in the sequence.
  double mean = 0;          ///< Grey level.
  double dark_level = 0;    ///< The grey level that 2 % of the pixels lie below.
  double bright_level = 0;  ///< That which 2 % lie above.
  double white_share = 0;   ///< Of pixels at the upper end of the range.
  double levels_share = 0;  ///< Of the whole grey levels between dark and bright, those that occur.
  double edge_share = 0;    ///< Of pixels with a gradient that can be tracked.
  /// Steepness of the steepest edges at a quarter of the resolution, relative to that at the full one: about 1 in a
  /// sharp image, 4 in one that is as soft as if it had been enlarged four times.
  double softness = 0;
};

/// `grey`: 0..255, at least 32 x 32 pixels.
FrameFacts measure_frame(ImageView<const float> grey);

struct PairFacts {
  int index = 0;               ///< Of the later frame.
  bool is_repeated = false;    ///< Both are the same image.
  double brightness_step = 0;  ///< Log of the ratio of their mean grey levels.
  double tracked_share = 0;    ///< Of corners that are found again.
  double flow = 0;             ///< Median displacement of those, relative to the width of the image.
};

/// `before`, `after`: frames that follow each other, of one size.
PairFacts measure_pair(ImageView<const float> before, ImageView<const float> after);

}  // namespace ldso
