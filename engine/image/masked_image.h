#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ldso/image.h"

namespace ldso {

/// Intensity and validity in one float: irradiance is never negative, so the sign bit is free to say
/// "carries no information" (overexposed, black vignette, outside of the image). Interpolation and means
/// are taken of the magnitudes; the result is marked if any of its inputs is. Minus zero is a marked zero.
inline float mark_invalid(float intensity) { return -std::fabs(intensity); }
inline bool is_marked(float masked) { return std::signbit(masked); }

/// A buffer of masked intensities between two stages. Not filled on construction: each stage writes
/// every pixel, and clearing would cost as much as the stage itself.
class MaskedImage {
 public:
  MaskedImage() = default;
  MaskedImage(int width, int height)
      : width_(width),
        height_(height),
        pixels_(std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(width) * height)) {}

  ImageView<float> view() { return {pixels_.get(), width_, height_, width_}; }
  ImageView<const float> view() const { return {pixels_.get(), width_, height_, width_}; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::unique_ptr<float[]> pixels_;
};

}  // namespace ldso
