#pragma once

// A described corner of a keyframe: what place recognition knows of it.

#include <array>
#include <cstdint>

namespace ldso {

/// 256 binary intensity comparisons around a corner, turned with it (Rublee et al., ORB, ICCV 2011).
struct OrbDescriptor {
  std::array<std::uint64_t, 4> bits{};
  bool operator==(const OrbDescriptor&) const = default;
};

/// Number of differing bits, 0..256. Counted in parallel within words: the binary runs on machines without an
/// instruction for it, where std::popcount is a call and a table.
inline int hamming_distance(const OrbDescriptor& a, const OrbDescriptor& b) {
  constexpr std::uint64_t kTwos = 0x5555555555555555, kFours = 0x3333333333333333, kBytes = 0x0f0f0f0f0f0f0f0f;
  constexpr std::uint64_t kHalves = 0x00ff00ff00ff00ff;
  const auto in_nibbles = [&](int i) {
    std::uint64_t x = a.bits[i] ^ b.bits[i];
    x -= (x >> 1) & kTwos;
    return (x & kFours) + ((x >> 2) & kFours);
  };
  const std::uint64_t p = in_nibbles(0) + in_nibbles(1), q = in_nibbles(2) + in_nibbles(3);
  const std::uint64_t bytes = (p & kBytes) + ((p >> 4) & kBytes) + (q & kBytes) + ((q >> 4) & kBytes);
  const std::uint64_t halves = (bytes & kHalves) + ((bytes >> 8) & kHalves);
  return static_cast<int>((halves * 0x0001000100010001) >> 48);
}

struct Feature {
  OrbDescriptor descriptor;
  float u = 0, v = 0;  ///< Pixel in the rectified image.
  float angle = 0;     ///< Orientation by the intensity centroid [rad], -pi..pi.
};

}  // namespace ldso
