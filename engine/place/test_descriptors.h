#pragma once

// Made-up descriptors for the tests of this room.

#include <cstdint>
#include <random>
#include <vector>

#include "place/feature.h"

namespace ldso::place_test {

inline OrbDescriptor random_descriptor(std::mt19937_64& random) {
  OrbDescriptor descriptor;
  for (std::uint64_t& word : descriptor.bits) word = random();
  return descriptor;
}

/// Differs from `descriptor` in at most `count` bits.
inline OrbDescriptor flip_bits(OrbDescriptor descriptor, int count, std::mt19937_64& random) {
  for (int i = 0; i < count; ++i) {
    const auto bit = random() % 256;
    descriptor.bits[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

/// Images of a world of `places` places, each with its own 60 corners; image i shows place i % places.
inline std::vector<std::vector<OrbDescriptor>> made_up_images(int images, int places, std::uint64_t seed = 1) {
  constexpr int kCorners = 60;
  std::mt19937_64 random(seed);
  std::vector<OrbDescriptor> corners;
  for (int i = 0; i < places * kCorners; ++i) corners.push_back(random_descriptor(random));
  std::vector<std::vector<OrbDescriptor>> descriptors(static_cast<std::size_t>(images));
  for (int i = 0; i < images; ++i) {
    for (int j = 0; j < kCorners; ++j)
      descriptors[i].push_back(flip_bits(corners[(i % places) * kCorners + j], 12, random));
  }
  return descriptors;
}

inline std::vector<Feature> features_of(const std::vector<OrbDescriptor>& descriptors) {
  std::vector<Feature> features;
  for (const OrbDescriptor& descriptor : descriptors) features.push_back({descriptor, 0, 0, 0});
  return features;
}

}  // namespace ldso::place_test
