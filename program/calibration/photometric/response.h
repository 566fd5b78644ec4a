#pragma once
// The response of a camera from images of a scene that does not change, taken with many known exposure times (J. Engel,
// V. Usenko, D. Cremers, "A photometrically calibrated benchmark for monocular visual odometry", arXiv:1607.02555,
// section 2.3.1): the scene's irradiance and the inverse response are estimated in turn.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ldso/image.h"

namespace ldso {

/// Grey levels of the same pixels in each image.
struct ExposedImage {
  double exposure_ms = 0;
  std::vector<std::uint8_t> levels;
};

/// Every n-th pixel of an image of grey levels 0..255, so that there are at most some 60000.
std::vector<std::uint8_t> sampled_levels(ImageView<const float> grey);

struct ResponseEstimate {
  std::array<double, 256> inverse_response{};  ///< 0..255 for 0 and 255; nowhere decreases.
  double rms = 0;       ///< Of inverse response minus exposure times irradiance, with levels as its unit.
  int levels_seen = 0;  ///< Of 256; the others are between their neighbours.
};

/// Throws Error that calls the images `where` if there are fewer than 8, if their exposures do not span a factor of 8,
/// or if too few grey levels are seen.
ResponseEstimate estimate_response(const std::vector<ExposedImage>& images, const std::string& where);

/// The 256 values of pcalib.txt.
std::string response_text(const std::array<double, 256>& inverse_response);

}  // namespace ldso
