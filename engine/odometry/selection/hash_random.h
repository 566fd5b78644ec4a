#pragma once

// Random numbers as a function of what they are for: hashing (seed, frame, block) needs no generator
// state, so a choice does not depend on how many numbers others have drawn before.

#include <cstdint>

namespace ldso {

/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014).
constexpr std::uint64_t hash_random(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

constexpr std::uint64_t hash_random(std::uint64_t seed, std::uint64_t value) {
  return hash_random(seed ^ hash_random(value));
}

/// Uniform in [0, 1).
constexpr double unit_interval(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

/// Uniform in [0, count). The bias of count / 2^32 does not matter here.
constexpr int uniform_index(std::uint64_t hash, int count) {
  return static_cast<int>(((hash >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

}  // namespace ldso
