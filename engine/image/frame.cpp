#include "image/frame.h"

#include <cmath>
#include <cstring>

namespace ldso {
namespace {

/// The coarsest level still needs structure: about 48 x 30 pixels are the least that align a frame [px].
constexpr int kMinCoarsestWidth = 48;
/// The same for the height [px].
constexpr int kMinCoarsestHeight = 30;
/// As many as the iterations of tracking are set for.
constexpr int kMaxLevels = 6;

}  // namespace

bool same_image(const PreparedFrame& a, const PreparedFrame& b) {
  const auto &first = a.pyramid.levels.front(), &second = b.pyramid.levels.front();
  return a.exposure_ms == b.exposure_ms && first.width() == second.width() && first.height() == second.height() &&
         std::memcmp(first.data(), second.data(), first.size() * sizeof(Texel)) == 0;
}

int pyramid_level_count(int width, int height) {
  int levels = 1;
  while (levels < kMaxLevels && width / 2 >= kMinCoarsestWidth && height / 2 >= kMinCoarsestHeight) {
    width /= 2;
    height /= 2;
    ++levels;
  }
  return levels;
}

PinholeIntrinsics level_intrinsics(const PinholeIntrinsics& full, int level) {
  const double scale = std::ldexp(1.0, -level);
  PinholeIntrinsics result;
  result.width = full.width >> level;
  result.height = full.height >> level;
  result.fx = full.fx * scale;
  result.fy = full.fy * scale;
  result.cx = (full.cx + 0.5) * scale - 0.5;
  result.cy = (full.cy + 0.5) * scale - 0.5;
  return result;
}

}  // namespace ldso
