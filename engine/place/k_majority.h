#pragma once

// Divides a set of binary descriptors into clusters: k-means with the Hamming distance, where the centre of a cluster
// has each bit that most of its members have.

#include <cstdint>
#include <span>
#include <vector>

#include "place/feature.h"
#include "util/thread_pool.h"

namespace ldso {

struct Clusters {
  std::vector<OrbDescriptor> centers;    ///< None is without members.
  std::vector<std::uint8_t> cluster_of;  ///< Of each descriptor, the nearest centre; of equally near ones the first.
};

/// At most `count` (2..255) clusters; fewer if there are fewer different descriptors. `pool` may be null; the result
/// does not depend on it.
Clusters cluster_descriptors(std::span<const OrbDescriptor> descriptors, int count, int iterations, std::uint64_t seed,
                             ThreadPool* pool);

}  // namespace ldso
