#include "ldso/io/dataset.h"

#include <algorithm>
#include <cmath>

namespace ldso {

Image<Rgb> Dataset::read_color(int index) const {
  const RawFrame frame = read(index);
  Image<Rgb> image(frame.grey.width(), frame.grey.height());
  std::transform(frame.grey.data(), frame.grey.data() + frame.grey.size(), image.data(), [](float grey) {
    const auto level = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0F, 255.0F)));
    return Rgb{level, level, level};
  });
  return image;
}

}  // namespace ldso
