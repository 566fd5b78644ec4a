#pragma once

// What one photometric residual contributes to the normal equations, before it is multiplied by the Jacobian of its
// pixel.

namespace ldso {

/// Sums over the pattern of weight * x * y for x, y of: g = image gradient in the target, a and b = derivative of the
/// residual by the relative log brightness factor and offset of the target, r = residual [grey levels].
struct PatternSums {
  float gxx = 0, gxy = 0, gyy = 0;
  float gxa = 0, gya = 0, gxb = 0, gyb = 0;
  float aa = 0, ab = 0, bb = 0;
  float rgx = 0, rgy = 0, ra = 0, rb = 0;
  float energy = 0;      ///< Robust energy.
  bool in_view = false;  ///< All pixels fall inside the target image and at least half of them are valid there.
};

}  // namespace ldso
