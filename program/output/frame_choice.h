#pragma once
// Which frames of a run to show to a program that learns a scene from images: sharp ones, evenly spread over what the
// camera saw, and no more than it can hold.

#include <cstddef>
#include <functional>
#include <vector>

#include "imagery/posed_frames.h"
#include "ldso/image.h"

namespace ldso {

/// Splits the way of the camera into `count` stretches of equally much change of view (translation over `depth`, the
/// distance of what is seen, plus rotation) and takes of each the frame with the largest sharpness(index). Indices of
/// `frames`, in order; all if there are no more than `count`.
std::vector<std::size_t> choose_frames(const std::vector<FramePose>& frames, double depth, std::size_t count,
                                       const std::function<double(std::size_t)>& sharpness);

/// Mean of the squared differences of neighbouring grey levels: within a stretch the same things are seen, and what is
/// blurred has less.
double sharpness(ImageView<const float> image);

}  // namespace ldso
