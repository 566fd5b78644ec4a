#pragma once

// Random numbers as a function of what they are for: hashing (seed, frame, block) needs no generator state, so a choice
// does not depend on how many numbers others have drawn before, nor a rendered world on the number of threads.

#include <bit>
#include <cstdint>

namespace ldso {

/// The step from one state of SplitMix64 to the next (Steele, Lea, Flood: Fast splittable pseudorandom number
/// generators, OOPSLA 2014): 2^64 over the golden ratio.
inline constexpr std::uint64_t kSplitMixStep = 0x9e3779b97f4a7c15ULL;

/// What SplitMix64 makes of a state.
constexpr std::uint64_t splitmix_output(std::uint64_t state) {
  state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ULL;
  state = (state ^ (state >> 27)) * 0x94d049bb133111ebULL;
  return state ^ (state >> 31);
}

/// Bits that look random, and other ones for each key.
constexpr std::uint64_t hash_of(std::uint64_t key) { return splitmix_output(key + kSplitMixStep); }

/// Of several keys; their order counts.
constexpr std::uint64_t hash_of(std::uint64_t a, std::uint64_t b) { return hash_of(hash_of(a) ^ b); }
constexpr std::uint64_t hash_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) { return hash_of(hash_of(a, b), c); }

/// Uniform in [0, 1).
constexpr double unit_interval(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }
constexpr float unit_interval_float(std::uint64_t hash) { return static_cast<float>(hash >> 40) * 0x1p-24f; }

/// Uniform in [0, count). The bias of count / 2^32 does not matter here.
constexpr int uniform_index(std::uint64_t hash, int count) {
  return static_cast<int>(((hash >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

/// Tells whether bytes are the same ones: FNV-1a (Fowler, Noll, Vo).
class Checksum {
 public:
  constexpr void add(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001b3ULL; }
  /// Its bytes, the lowest first.
  constexpr void add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    for (int shift = 0; shift < 64; shift += 8) add(static_cast<std::uint8_t>(bits >> shift));
  }
  constexpr std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace ldso
