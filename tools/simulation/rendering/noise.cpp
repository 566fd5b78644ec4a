#include "simulation/rendering/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ldso::simulation {
namespace {

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// Without the library call that std::floor is on the oldest processors.
std::int64_t floor_to_int(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - static_cast<std::int64_t>(x < static_cast<double>(truncated));
}

struct Gradient {
  double x, y;
  double dot(double dx, double dy) const { return x * dx + y * dy; }
};

std::vector<Gradient> make_gradients(std::uint64_t seed, int cells) {
  std::vector<Gradient> gradients;
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const double angle = unit_interval(hash_of(seed, ix, iy)) * 2 * std::numbers::pi;
      gradients.push_back({std::cos(angle), std::sin(angle)});
    }
  }
  return gradients;
}

/// Gradient noise with a period of `cells`, added to all samples of the tile.
void add_octave(std::vector<float>& values, std::uint64_t seed, int cells, double amplitude) {
  const std::vector<Gradient> gradients = make_gradients(seed, cells);
  const int size = NoiseTile::kSize;
  const double step = static_cast<double>(cells) / size;
  for (int row = 0; row < size; ++row) {
    const int iy = static_cast<int>(row * step), jy = (iy + 1) % cells;
    const double fy = row * step - iy;
    for (int column = 0; column < size; ++column) {
      const int ix = static_cast<int>(column * step), jx = (ix + 1) % cells;
      const double fx = column * step - ix;
      const Gradient *above = &gradients[iy * cells], *below = &gradients[jy * cells];
      const double top = std::lerp(above[ix].dot(fx, fy), above[jx].dot(fx - 1, fy), fade(fx));
      const double bottom = std::lerp(below[ix].dot(fx, fy - 1), below[jx].dot(fx - 1, fy - 1), fade(fx));
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
  const std::int64_t cell_x = floor_to_int(x), cell_y = floor_to_int(y);
  const auto fx = static_cast<float>(x - static_cast<double>(cell_x));
  const auto fy = static_cast<float>(y - static_cast<double>(cell_y));
  const int mask = kSize - 1;
  const int ix = static_cast<int>(cell_x & mask), iy = static_cast<int>(cell_y & mask);
  const float* top = values_.data() + static_cast<std::size_t>(iy) * kSize;
  const float* bottom = values_.data() + static_cast<std::size_t>((iy + 1) & mask) * kSize;
  const int jx = (ix + 1) & mask;
  const float above = top[ix] + fx * (top[jx] - top[ix]);
  const float below = bottom[ix] + fx * (bottom[jx] - bottom[ix]);
  return above + fy * (below - above);
}

const NoiseTiles& noise_tiles() {
  static const NoiseTiles kTiles{NoiseTile(11, 4, 6, 0.5), NoiseTile(12, 8, 6, 0.75), NoiseTile(13, 64, 3, 1.0)};
  return kTiles;
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
  static const std::vector<float> kQuantiles = make_quantiles();
  return kQuantiles[hash_of(key) & 0xffff];
}

}  // namespace ldso::simulation
