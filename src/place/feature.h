#pragma once

// A described corner of a keyframe: what place recognition knows of it.

#include <array>
#include <bit>
#include <cstdint>

namespace ldso {

/// 256 binary intensity comparisons around a corner, turned with it (Rublee et al., ORB, ICCV 2011).
struct OrbDescriptor {
  std::array<std::uint64_t, 4> bits{};
  bool operator==(const OrbDescriptor&) const = default;
};

/// Number of differing bits, 0..256.
inline int hamming_distance(const OrbDescriptor& a, const OrbDescriptor& b) {
  int distance = 0;
  for (int i = 0; i < 4; ++i) distance += std::popcount(a.bits[i] ^ b.bits[i]);
  return distance;
}

struct Feature {
  float u = 0, v = 0;  ///< Pixel in the rectified image.
  float angle = 0;     ///< Orientation by the intensity centroid [rad], -pi..pi.
  OrbDescriptor descriptor;
};

}  // namespace ldso
