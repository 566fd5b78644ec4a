#pragma once
// A picture to judge a calibration by: what is straight in the world has to be straight in the rectified image.

#include "image/frame_preprocessor.h"
#include "io/images/image_file.h"
#include "ldso/raw_frame.h"

namespace ldso {

/// The frame as it was taken on the left, rectified on the right with a grid of straight lines; what is not used is
/// tinted red. Both have the same height.
Image<Rgb> draw_preview(const RawFrame& frame, const FramePreprocessor& preprocessor);

}  // namespace ldso
