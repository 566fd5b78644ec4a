#include "image/pyramid.h"

#include <utility>

#include "image/masked_image.h"
#include "image/pyramid_kernels.h"

namespace ldso {

ImagePyramid build_pyramid(ImageView<const float> masked) {
  const int count = pyramid_level_count(masked.width, masked.height);
  ImagePyramid pyramid;
  pyramid.levels.reserve(count);
  MaskedImage current;
  ImageView<const float> view = masked;
  for (int level = 0; level < count; ++level) {
    if (level > 0) {
      MaskedImage coarser(view.width / 2, view.height / 2);
      downsample(view, coarser.view());
      current = std::move(coarser);
      view = current.view();
    }
    Image<Texel>& texels = pyramid.levels.emplace_back(view.width, view.height, Uninitialized{});
    make_texels(view, texels.view());
  }
  return pyramid;
}

}  // namespace ldso
