#include "simulation/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ldso::simulation {
namespace {

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// Contribution of the lattice gradient at (ix, iy), seen from (dx, dy).
double gradient_dot(std::uint64_t seed, int ix, int iy, double dx, double dy) {
  const double angle = static_cast<double>(hash_of(seed, ix, iy) >> 11) * 0x1.0p-53 * 2 * std::numbers::pi;
  return std::cos(angle) * dx + std::sin(angle) * dy;
}

/// Gradient noise with a period of `cells`, added to all samples of the tile.
void add_octave(std::vector<float>& values, std::uint64_t seed, int cells, double amplitude) {
  const int size = NoiseTile::kSize;
  const double step = static_cast<double>(cells) / size;
  for (int row = 0; row < size; ++row) {
    const int iy = static_cast<int>(row * step);
    const double fy = row * step - iy;
    for (int column = 0; column < size; ++column) {
      const int ix = static_cast<int>(column * step);
      const double fx = column * step - ix;
      const int jx = (ix + 1) % cells, jy = (iy + 1) % cells;
      const double top =
          std::lerp(gradient_dot(seed, ix, iy, fx, fy), gradient_dot(seed, jx, iy, fx - 1, fy), fade(fx));
      const double bottom =
          std::lerp(gradient_dot(seed, ix, jy, fx, fy - 1), gradient_dot(seed, jx, jy, fx - 1, fy - 1), fade(fx));
      values[static_cast<std::size_t>(row) * size + column] +=
          static_cast<float>(amplitude * std::lerp(top, bottom, fade(fy)));
    }
  }
}

void normalize(std::vector<float>& values) {
  double sum = 0, sum_squares = 0;
  for (const float v : values) {
    sum += v;
    sum_squares += static_cast<double>(v) * v;
  }
  const double mean = sum / static_cast<double>(values.size());
  const double deviation = std::sqrt(sum_squares / static_cast<double>(values.size()) - mean * mean);
  for (float& v : values) v = static_cast<float>((v - mean) / deviation);
}

/// Inverse of the normal distribution function by bisection (used for a table only).
double normal_quantile(double probability) {
  double low = -6, high = 6;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<float> make_quantiles() {
  std::vector<float> table(65536);
  for (int i = 0; i < 32768; ++i) {
    table[i] = static_cast<float>(normal_quantile((i + 0.5) / 65536.0));
    table[65535 - i] = -table[i];
  }
  return table;
}

}  // namespace

NoiseTile::NoiseTile(std::uint64_t seed, int lowest, int octaves, double gain)
    : values_(static_cast<std::size_t>(kSize) * kSize, 0.0f) {
  double amplitude = 1;
  for (int octave = 0; octave < octaves && (lowest << octave) <= kSize / 2; ++octave) {
    add_octave(values_, hash_of(seed, octave), lowest << octave, amplitude);
    amplitude *= gain;
  }
  normalize(values_);
}

float NoiseTile::at(double x, double y) const {
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const auto fx = static_cast<float>(x - floor_x), fy = static_cast<float>(y - floor_y);
  const int mask = kSize - 1;
  const int ix = static_cast<int>(static_cast<std::int64_t>(floor_x) & mask);
  const int iy = static_cast<int>(static_cast<std::int64_t>(floor_y) & mask);
  const float* top = values_.data() + static_cast<std::size_t>(iy) * kSize;
  const float* bottom = values_.data() + static_cast<std::size_t>((iy + 1) & mask) * kSize;
  const int jx = (ix + 1) & mask;
  const float above = top[ix] + fx * (top[jx] - top[ix]);
  const float below = bottom[ix] + fx * (bottom[jx] - bottom[ix]);
  return above + fy * (below - above);
}

const NoiseTiles& noise_tiles() {
  static const NoiseTiles tiles{NoiseTile(11, 4, 6, 0.5), NoiseTile(12, 8, 6, 0.75), NoiseTile(13, 64, 3, 1.0)};
  return tiles;
}

SmoothNoise::SmoothNoise(std::uint64_t seed, double frequency, int terms) {
  Random random(seed, 0x5310);
  double power = 0;
  for (int i = 0; i < terms; ++i) {
    const double relative = 0.4 + 1.2 * (i + random.uniform()) / terms;
    const double amplitude = 1 / relative;
    terms_.push_back({amplitude, 2 * std::numbers::pi * frequency * relative, random.uniform(0, 2 * std::numbers::pi)});
    power += 0.5 * amplitude * amplitude;
  }
  for (Term& term : terms_) term.amplitude /= std::sqrt(power);
}

double SmoothNoise::at(double t) const {
  double sum = 0;
  for (const Term& term : terms_) sum += term.amplitude * std::sin(term.omega * t + term.phase);
  return sum;
}

float gaussian_of(std::uint64_t key) {
  static const std::vector<float> quantiles = make_quantiles();
  return quantiles[mix_bits(key) & 0xffff];
}

}  // namespace ldso::simulation
