#pragma once

// Idea: everything random in a simulated world comes from hashes of a seed and a position, so a world is the
// same in every run and for any number of threads.

#include <cstdint>
#include <vector>

#include "util/hash.h"

namespace ldso::simulation {

/// A seeded stream of random numbers with a fixed definition (the standard distributions have none).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(hash_of(seed)) {}
  Random(std::uint64_t seed, std::uint64_t stream) : state_(hash_of(seed, stream)) {}

  std::uint64_t bits() { return hash_of(state_++); }
  /// Uniform in [0, 1).
  double uniform() { return unit_interval(bits()); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in [0, count).
  int index(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
};

/// A periodic tile of multi-octave gradient noise (Perlin 2002), zero mean, about unit variance, sampled bilinearly.
class NoiseTile {
 public:
  static constexpr int kSize = 512;  ///< Samples a side; one period.

  /// `lowest` cells a period in the first octave; each octave has twice the frequency and `gain` times the amplitude.
  NoiseTile(std::uint64_t seed, int lowest, int octaves, double gain);

  /// Value at (x, y) in samples; wraps around.
  float at(double x, double y) const;

 private:
  std::vector<float> values_;
};

/// The tiles that all painters share: `cloudy` is dominated by low frequencies, `natural` falls with 1/f as pictures
/// of real surfaces do, `grain` is mostly fine.
struct NoiseTiles {
  NoiseTile cloudy;
  NoiseTile natural;
  NoiseTile grain;
};
const NoiseTiles& noise_tiles();

/// Smooth random function of time: a sum of sines with seeded phases, about unit variance, frequencies around
/// `frequency` [Hz].
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t seed, double frequency, int terms = 5);
  double at(double t) const;

 private:
  struct Term {
    double amplitude, omega, phase;
  };
  std::vector<Term> terms_;
};

/// Standard normal deviate belonging to a key, from a table of quantiles (65536 steps, bounded by 4.3).
float gaussian_of(std::uint64_t key);

}  // namespace ldso::simulation
