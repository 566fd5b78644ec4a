#pragma once

// Images of all pixel types as the grey levels that everything works on, 0..255.

#include <cstdint>

#include "ldso/image.h"

namespace ldso {

/// By so much a pixel is multiplied: 65535 is as bright as 255, numbers that are no integers are grey levels already.
template <class T>
inline constexpr float kGreyLevel = 1.0f;
template <>
inline constexpr float kGreyLevel<std::uint16_t> = 1.0f / 257.0f;

template <class T>
Image<float> to_grey(ImageView<const T> image) {
  Image<float> grey(image.width, image.height, Uninitialized{});
  for (int y = 0; y < image.height; ++y) {
    const T* from = image.row(y);
    float* to = grey.row(y);
    for (int x = 0; x < image.width; ++x) to[x] = kGreyLevel<T> * static_cast<float>(from[x]);
  }
  return grey;
}

}  // namespace ldso
