#pragma once
// Wilcoxon's signed-rank test: do paired values differ, whatever their distribution?
// F. Wilcoxon, Individual comparisons by ranking methods, Biometrics Bulletin 1, 1945.

#include <cstddef>
#include <vector>

namespace ldso {

struct SignedRankTest {
  std::size_t pairs = 0;  ///< That differ; the others say nothing (Wilcoxon leaves them out).
  double plus = 0;        ///< Sum of the ranks of positive differences.
  double minus = 0;       ///< Of negative ones.
  double p = 1;           ///< Two-sided: probability of ranks at least as one-sided if both signs are equally likely.
};

/// Differences may be infinite (these rank highest, alike) but not NaN. Equal sizes get the mean of their ranks. p is
/// exact, also with equal sizes (all signs are counted), up to kMostExactPairs pairs that differ; beyond, it is that of
/// the normal distribution with corrections for equal sizes and continuity.
SignedRankTest signed_rank_test(const std::vector<double>& differences);

inline constexpr std::size_t kMostExactPairs = 100;

}  // namespace ldso
