#include <cmath>

#include "image/interpolation.h"
#include "odometry/depth/search_kernels.h"
#include "odometry/state/robust_weight.h"

namespace ldso {

void search_energies_reference(const PatternSearch& search, int count, float* energies) {
  // The height of the image is not known here, nor asked for.
  const ImageView<const Texel> texels{search.texels, search.width, 0, search.width};
  for (int n = 0; n < count; ++n) {
    energies[n] = 0;
    for (int i = 0; i < kPatternSize; ++i) {
      const float x = search.x + static_cast<float>(n) * search.step_x + search.offset_x[i];
      const float y = search.y + static_cast<float>(n) * search.step_y + search.offset_y[i];
      const Texel t = quadratic(texels, x, y);
      const float r = t.valid > kAllValid ? std::fabs(t.intensity - search.intensity[i]) : kInvalidResidual;
      energies[n] += huber_energy(r);
    }
  }
}

}  // namespace ldso
