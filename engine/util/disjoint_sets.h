#pragma once

// Sets that are joined step by step (union-find with path halving).

#include <cstddef>
#include <numeric>
#include <vector>

namespace ldso {

class DisjointSets {
 public:
  /// Each of the numbers below `size` is a set of its own.
  explicit DisjointSets(std::size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0); }

  /// The number that stands for the set of `i`.
  std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parents_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace ldso
