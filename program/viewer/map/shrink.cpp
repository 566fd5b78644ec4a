#include "viewer/map/shrink.h"

#include <algorithm>

namespace ldso {

Image<float> shrink(ImageView<const float> image, int most_width) {
  const int factor = std::max(1, (image.width + most_width - 1) / most_width);
  Image<float> small(image.width / factor, image.height / factor);
  for (int y = 0; y < small.height(); ++y) {
    for (int x = 0; x < small.width(); ++x) {
      float sum = 0;
      for (int dy = 0; dy < factor; ++dy) {
        for (int dx = 0; dx < factor; ++dx) sum += image(factor * x + dx, factor * y + dy);
      }
      small(x, y) = sum / static_cast<float>(factor * factor);
    }
  }
  return small;
}

}  // namespace ldso
