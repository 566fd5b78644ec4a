#include "place/k_majority.h"

#include <algorithm>
#include <array>
#include <random>

namespace ldso {
namespace {

/// Descriptors that a thread takes at once.
constexpr int kChunk = 4096;
/// Of an ORB descriptor.
constexpr int kBits = 256;

/// All sums below are of integers: they do not depend on how the work is divided.
class Clustering {
 public:
  Clustering(std::span<const OrbDescriptor> descriptors, ThreadPool* pool)
      : descriptors_(descriptors), count_(static_cast<int>(descriptors.size())), pool_(pool) {}

  Clusters run(int clusters, int iterations, std::uint64_t seed) {
    choose_seeds(clusters, seed);
    result_.cluster_of.assign(descriptors_.size(), 0);
    assign();
    for (int i = 0; i < iterations; ++i) {
      move_centers();
      if (!assign()) break;
    }
    drop_empty();
    return std::move(result_);
  }

 private:
  template <class Task>
  void for_chunks(const Task& task) {
    if (pool_ != nullptr) {
      pool_->for_chunks(count_, kChunk, task);
      return;
    }
    for (int chunk = 0, begin = 0; begin < count_; ++chunk, begin += kChunk)
      task(chunk, begin, std::min(begin + kChunk, count_));
  }

  /// k-means++: each further seed is drawn with a probability that grows with the squared distance to the nearest one.
  void choose_seeds(int clusters, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::uint32_t> squares(descriptors_.size(), kBits * kBits);
    std::vector<std::uint64_t> chunk_sums(static_cast<std::size_t>(ThreadPool::chunk_count(count_, kChunk)));
    std::size_t next = random() % descriptors_.size();
    while (true) {
      const OrbDescriptor center = descriptors_[next];
      result_.centers.push_back(center);
      if (static_cast<int>(result_.centers.size()) == clusters) return;
      for_chunks([&](int chunk, int begin, int end) {
        std::uint64_t sum = 0;
        for (int i = begin; i < end; ++i) {
          const auto distance = static_cast<std::uint32_t>(hamming_distance(descriptors_[i], center));
          squares[i] = std::min(squares[i], distance * distance);
          sum += squares[i];
        }
        chunk_sums[chunk] = sum;
      });
      std::uint64_t total = 0;
      for (const std::uint64_t sum : chunk_sums) total += sum;
      if (total == 0) return;  // Every descriptor is a centre.
      next = draw(squares, random() % total);
    }
  }

  /// The element in which the running sum passes `target`.
  static std::size_t draw(const std::vector<std::uint32_t>& weights, std::uint64_t target) {
    std::size_t i = 0;
    while (target >= weights[i]) target -= weights[i++];
    return i;
  }

  /// True if a descriptor has changed its cluster.
  bool assign() {
    std::vector<char> changed(static_cast<std::size_t>(ThreadPool::chunk_count(count_, kChunk)), 0);
    for_chunks([&](int chunk, int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const std::uint8_t nearest = nearest_center(descriptors_[i]);
        if (nearest == result_.cluster_of[i]) continue;
        result_.cluster_of[i] = nearest;
        changed[chunk] = 1;
      }
    });
    return std::find(changed.begin(), changed.end(), 1) != changed.end();
  }

  std::uint8_t nearest_center(const OrbDescriptor& descriptor) const {
    int nearest = 0, least = kBits + 1;
    for (int i = 0; i < static_cast<int>(result_.centers.size()); ++i) {
      const int distance = hamming_distance(descriptor, result_.centers[i]);
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return static_cast<std::uint8_t>(nearest);
  }

  struct Votes {
    std::uint32_t members = 0;
    std::array<std::uint32_t, kBits> ones{};
  };

  static void add_votes(const OrbDescriptor& descriptor, Votes& votes) {
    ++votes.members;
    for (int i = 0; i < kBits; ++i) votes.ones[i] += (descriptor.bits[i / 64] >> (i % 64)) & 1;
  }

  void move_centers() {
    const std::size_t clusters = result_.centers.size();
    std::vector<std::vector<Votes>> chunk_votes(static_cast<std::size_t>(ThreadPool::chunk_count(count_, kChunk)));
    for_chunks([&](int chunk, int begin, int end) {
      std::vector<Votes> votes(clusters);
      for (int i = begin; i < end; ++i) add_votes(descriptors_[i], votes[result_.cluster_of[i]]);
      chunk_votes[chunk] = std::move(votes);
    });
    for (std::size_t i = 0; i < clusters; ++i) {
      Votes sum;
      for (const std::vector<Votes>& votes : chunk_votes) {
        sum.members += votes[i].members;
        for (int bit = 0; bit < kBits; ++bit) sum.ones[bit] += votes[i].ones[bit];
      }
      vote(sum, result_.centers[i]);
    }
  }

  /// A tie leaves the bit as it is, and a cluster without members its centre.
  static void vote(const Votes& votes, OrbDescriptor& center) {
    for (int i = 0; i < kBits; ++i) {
      const std::uint64_t mask = std::uint64_t{1} << (i % 64);
      if (2 * votes.ones[i] > votes.members) center.bits[i / 64] |= mask;
      if (2 * votes.ones[i] < votes.members) center.bits[i / 64] &= ~mask;
    }
  }

  void drop_empty() {
    std::vector<int> members(result_.centers.size(), 0);
    for (const std::uint8_t cluster : result_.cluster_of) ++members[cluster];
    std::vector<std::uint8_t> renamed(members.size(), 0);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i] == 0) continue;
      renamed[i] = static_cast<std::uint8_t>(kept);
      result_.centers[kept++] = result_.centers[i];
    }
    result_.centers.resize(kept);
    for (std::uint8_t& cluster : result_.cluster_of) cluster = renamed[cluster];
  }

  std::span<const OrbDescriptor> descriptors_;
  int count_;
  ThreadPool* pool_;
  Clusters result_;
};

}  // namespace

Clusters cluster_descriptors(std::span<const OrbDescriptor> descriptors, int count, int iterations, std::uint64_t seed,
                             ThreadPool* pool) {
  if (descriptors.empty()) return {};
  return Clustering(descriptors, pool).run(count, iterations, seed);
}

}  // namespace ldso
