#include "image/image_structure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ldso {
namespace {

/// Root mean square gradient of an image in which nothing is to be seen, at most [grey levels a pixel]. Noise of a grey
/// level leaves 0.2 on the second coarser level, a room at a tenth of its usual light 1.
constexpr double kLeastStructure = 0.3;
/// Gradient of the finest level over that of the second coarser one, of an image that is blurred, at most. A perfect
/// ramp has 0.25. Of sequences at hand, a thousand images of a hand-held camera that swings (motion blur, JPEG) have
/// 0.35 to 0.6, others 0.4 to 0.8, images blurred by a box of 21 pixels 0.29.
constexpr double kLeastSharpness = 0.32;
/// Level on which images are judged that may be noisy.
constexpr std::size_t kCoarseLevel = 2;
/// Pixels of which every so many are looked at, in each direction.
constexpr int kStride = 2;

ImageView<const Texel> coarse_level(const ImagePyramid& pyramid) {
  return pyramid.levels.at(std::min(kCoarseLevel, pyramid.levels.size() - 1)).view();
}

double coarse_gradient(const ImagePyramid& pyramid) { return rms_gradient(coarse_level(pyramid)); }

}  // namespace

double rms_gradient(const ImageView<const Texel>& level) {
  double squares = 0;
  int count = 0;
  for (int y = 0; y < level.height; y += kStride) {
    for (int x = 0; x < level.width; x += kStride) {
      const Texel& texel = level.row(y)[x];
      if (!texel.valid) continue;
      squares += texel.dx * texel.dx + texel.dy * texel.dy;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

LightOfImage light_of(const ImagePyramid& pyramid) {
  const ImageView<const Texel> level = coarse_level(pyramid);
  double sum = 0;
  int valid = 0, all = 0;
  for (int y = 0; y < level.height; y += kStride) {
    for (int x = 0; x < level.width; x += kStride, ++all) {
      const Texel& texel = level.row(y)[x];
      if (!texel.valid) continue;
      sum += texel.intensity;
      ++valid;
    }
  }
  if (valid == 0) return {};
  return {sum / valid, static_cast<double>(valid) / all};
}

bool has_structure(const ImagePyramid& pyramid) { return coarse_gradient(pyramid) > kLeastStructure; }

bool is_blurred(const ImagePyramid& pyramid) {
  if (pyramid.levels.size() <= kCoarseLevel) return false;
  return rms_gradient(pyramid.levels.front().view()) < kLeastSharpness * coarse_gradient(pyramid);
}

}  // namespace ldso
