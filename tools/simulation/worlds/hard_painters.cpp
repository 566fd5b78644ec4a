#include "simulation/worlds/hard_painters.h"

#include <algorithm>
#include <cmath>

#include "simulation/worlds/painters.h"
#include "simulation/worlds/smooth_step.h"

namespace ldso::simulation {
namespace {

constexpr double kBar = 0.06;  ///< Width of a window's bars [m].
constexpr float kBarAlbedo = 0.66f;
constexpr float kSkyAlbedo = 0.9f;

/// Two ranges of hills one behind the other, paler with distance.
void hazy_hills(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  const PlacedNoise near_ridge(noise_tiles().natural, 0.8, hash_of(seed, 1)),
      far_ridge(noise_tiles().cloudy, 1.2, hash_of(seed, 2)), woods(noise_tiles().natural, 0.25, hash_of(seed, 3));
  Random random(seed, 4);
  const double height = y1 - y0, far_top = y0 + random.uniform(0.4, 0.5) * height, near_top = far_top + 0.2 * height;
  canvas.apply(x0, y0, x1, y1, [&](double x, double y, float) {
    const double n = woods.at(x, y);
    const double far = smooth_step(-0.004, 0.004, y - far_top - 0.08 * height * far_ridge.at(x, 0)),
                 near = smooth_step(-0.004, 0.004, y - near_top - 0.06 * height * near_ridge.at(x, 0));
    const double behind = kSkyAlbedo + far * (0.78 + 0.02 * n - kSkyAlbedo);
    return behind + near * (0.66 + 0.05 * n - behind);
  });
}

}  // namespace

void reduce_contrast(Canvas& canvas, float share) {
  double sum = 0;
  for (std::size_t i = 0; i < canvas.image().size(); ++i) sum += canvas.image().data()[i];
  const auto mean = static_cast<float>(sum / static_cast<double>(canvas.image().size()));
  canvas.apply([&](double, double, float old) { return mean + share * (old - mean); });
}

void paint_repetitive_wallpaper(Canvas& canvas, std::uint64_t seed) {
  Random random(seed, 12);
  const double pitch = random.uniform(0.1, 0.16), radius = random.uniform(0.2, 0.3) * pitch;
  const double albedo = random.uniform(0.5, 0.68), blossom = random.uniform(0.55, 0.75);
  const auto within = [&](double x) { return x - std::floor(x / pitch) * pitch - 0.5 * pitch; };
  canvas.apply([&](double x, double y, float) {
    const double dx = within(x), dy = within(y);
    const double flower = smooth_step(0.004, -0.004, std::hypot(dx, dy) - radius),
                 heart = smooth_step(0.004, -0.004, std::hypot(dx, dy) - 0.4 * radius),
                 stripe = smooth_step(0.004, -0.004, std::abs(dx) - 0.08 * pitch);
    return albedo * (1 - 0.15 * stripe) * (1 - (1 - blossom) * flower) * (1 + 0.4 * heart);
  });
}

void paint_panorama(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  hazy_hills(canvas, x0, y0, x1, y1, seed);
  Random random(seed, 13);
  const int panes = 3 + random.index(3);
  const double pane = (x1 - x0 - kBar) / panes, cross = y0 + random.uniform(0.2, 0.35) * (y1 - y0);
  for (int i = 0; i <= panes; ++i) canvas.rectangle(x0 + i * pane, y0, x0 + i * pane + kBar, y1, kBarAlbedo);
  for (const double y : {y0, cross, y1 - kBar}) canvas.rectangle(x0, y, x1, y + kBar, kBarAlbedo);
}

void paint_posters(Canvas& canvas, std::uint64_t seed) {
  paint_plaster(canvas, 0.55f, seed);
  Random random(seed, 14);
  for (double y = 0.05; y < canvas.height() - 0.2;) {
    const double row = std::min(random.uniform(0.45, 0.9), canvas.height() - y);
    for (double x = random.uniform(0.0, 0.2); x < canvas.width() - 0.2;) {
      const double width = std::min(random.uniform(0.6, 1.3) * row, canvas.width() - x);
      paint_picture(canvas, x, y, x + width, y + random.uniform(0.85, 1.0) * row, random.bits());
      x += width + random.uniform(0.02, 0.12);
    }
    y += row + random.uniform(0.02, 0.08);
  }
}

}  // namespace ldso::simulation
