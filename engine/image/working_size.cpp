#include "image/working_size.h"

#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

/// Pixel centres are at integers: the image begins half a pixel before the first one.
double scaled_centre(double centre, double scale) { return scale * (centre + 0.5) - 0.5; }

}  // namespace

Calibration with_longest_side(Calibration calibration, int longest_side) {
  Rectification& rectification = calibration.rectification;
  const int width = rectification.width > 0 ? rectification.width : calibration.camera.width;
  const int height = rectification.height > 0 ? rectification.height : calibration.camera.height;
  if (longest_side <= 0 || std::max(width, height) <= longest_side) return calibration;
  rectification.width =
      static_cast<int>(std::lround(static_cast<double>(longest_side) * width / std::max(width, height)));
  rectification.height =
      static_cast<int>(std::lround(static_cast<double>(longest_side) * height / std::max(width, height)));
  if (rectification.mode == RectificationMode::kNone) rectification.mode = RectificationMode::kCrop;
  if (rectification.mode != RectificationMode::kExplicit) return calibration;
  PinholeIntrinsics& given = rectification.explicit_intrinsics;
  const double scale_x = static_cast<double>(rectification.width) / width;
  const double scale_y = static_cast<double>(rectification.height) / height;
  given = {rectification.width,
           rectification.height,
           scale_x * given.fx,
           scale_y * given.fy,
           scaled_centre(given.cx, scale_x),
           scaled_centre(given.cy, scale_y)};
  return calibration;
}

}  // namespace ldso
