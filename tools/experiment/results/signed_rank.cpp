#include "experiment/results/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ldso {
namespace {

/// Twice the rank of each size, so that means of two ranks are whole.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] < sizes[b]; });
  std::vector<std::size_t> ranks(sizes.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && sizes[order[end]] == sizes[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = first + 1 + end;  // First rank + last rank.
    first = end;
  }
  return ranks;
}

/// P(sum of the ranks with positive sign <= limit) if every sign is as likely as its opposite.
double probability_up_to(std::size_t limit, const std::vector<std::size_t>& ranks) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::vector<double> probability(total + 1, 0.0);
  probability[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks) {
    reached += rank;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      probability[sum] = 0.5 * (probability[sum] + (sum >= rank ? probability[sum - rank] : 0.0));
    }
  }
  return std::accumulate(probability.begin(), probability.begin() + static_cast<std::ptrdiff_t>(limit) + 1, 0.0);
}

/// The same by the normal distribution of equal mean and variance.
double approximate_probability_up_to(std::size_t limit, const std::vector<std::size_t>& ranks) {
  double mean = 0, variance = 0;  // Of the sum of doubled ranks.
  for (const std::size_t rank : ranks) {
    mean += 0.5 * static_cast<double>(rank);
    variance += 0.25 * static_cast<double>(rank) * static_cast<double>(rank);
  }
  const double z = (static_cast<double>(limit) + 1 - mean) / std::sqrt(variance);  // 1: half of a rank.
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

SignedRankTest signed_rank_test(const std::vector<double>& differences) {
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (const double difference : differences) {
    if (difference == 0) continue;
    sizes.push_back(std::abs(difference));
    is_positive.push_back(difference > 0);
  }
  SignedRankTest test;
  test.pairs = sizes.size();
  if (sizes.empty()) return test;
  const std::vector<std::size_t> ranks = doubled_ranks(sizes);
  std::size_t plus = 0, minus = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) (is_positive[i] ? plus : minus) += ranks[i];
  test.plus = 0.5 * static_cast<double>(plus);
  test.minus = 0.5 * static_cast<double>(minus);
  const auto probability = test.pairs <= kMostExactPairs ? probability_up_to : approximate_probability_up_to;
  test.p = std::min(1.0, 2 * probability(std::min(plus, minus), ranks));
  return test;
}

}  // namespace ldso
