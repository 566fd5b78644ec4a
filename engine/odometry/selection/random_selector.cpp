#include "odometry/selection/random_selector.h"

#include "util/hash.h"

namespace ldso {
namespace {

// Trials a wanted pixel: finds them all even if only one pixel in 30 has the gradient.
constexpr int kTrialsPerPixel = 64;

bool has_gradient(const Texel& texel) {
  return texel.dx * texel.dx + texel.dy * texel.dy >= RandomSelector::kLeastGradient * RandomSelector::kLeastGradient;
}

bool is_clear(const Image<Texel>& level, int x, int y) {
  for (int dy = -kSelectionClearance; dy <= kSelectionClearance; ++dy) {
    for (int dx = -kSelectionClearance; dx <= kSelectionClearance; ++dx) {
      if (level(x + dx, y + dy).valid < 1.0f) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<SelectedPixel> RandomSelector::select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) {
  check_pyramid(pyramid, frame_id);
  const Image<Texel>& level = pyramid.levels[0];
  const int columns = level.width() - 2 * kSelectionMargin;
  const int rows = level.height() - 2 * kSelectionMargin;
  std::vector<SelectedPixel> selected;
  if (columns <= 0 || rows <= 0) return selected;
  Image<std::uint8_t> taken(level.width(), level.height(), 0);
  const std::uint64_t seed = hash_of(frame_id, settings_.seed);
  const std::int64_t trials = std::int64_t{kTrialsPerPixel} * wanted;
  for (std::int64_t i = 0; i < trials && static_cast<int>(selected.size()) < wanted; ++i) {
    const int x = kSelectionMargin + uniform_index(hash_of(2 * i, seed), columns);
    const int y = kSelectionMargin + uniform_index(hash_of(2 * i + 1, seed), rows);
    if (taken(x, y) || !has_gradient(level(x, y)) || !is_clear(level, x, y)) continue;
    taken(x, y) = 1;
    selected.push_back({x, y, false, 1.0f});
  }
  return selected;
}

}  // namespace ldso
