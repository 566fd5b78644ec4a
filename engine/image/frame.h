#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/raw_frame.h"

namespace ldso {

/// One pixel of a pyramid level: irradiance (0..255), its central differences [1 / px of this level]
/// and 1 where it may be used, 0 where it is overexposed or outside of the camera's image.
struct alignas(16) Texel {
  float intensity = 0;
  float dx = 0;
  float dy = 0;
  float valid = 0;
};

/// Level 0 has full resolution. Level l is half of level l-1 (floor), pixel centres kept:
/// f_l = f_0 / 2^l, c_l = (c_0 + 0.5) / 2^l - 0.5.
struct ImagePyramid {
  std::vector<Image<Texel>> levels;
};

/// A frame ready for tracking: rectified, photometrically corrected.
struct PreparedFrame {
  std::int64_t id = 0;
  double timestamp = 0;
  double exposure_ms = 1.0;  ///< 1 where unknown or not to be used.
  bool exposure_known = false;
  ImagePyramid pyramid;
};

/// Whether both are the same image, pixel for pixel, as where a camera's driver hands one out twice: sensor noise makes
/// two images of a camera at rest differ.
bool same_image(const PreparedFrame& a, const PreparedFrame& b);

/// Number of usable pyramid levels for an image size, at most 6.
int pyramid_level_count(int width, int height);

/// Intrinsics of pyramid level `level`.
PinholeIntrinsics level_intrinsics(const PinholeIntrinsics& full, int level);

}  // namespace ldso
