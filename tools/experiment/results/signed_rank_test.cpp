#include "experiment/results/signed_rank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ldso {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// n differences of different sizes 1, 2, ..., n whose positive ones sum up to `plus`.
std::vector<double> differences_with_sum(int n, int plus) {
  std::vector<double> differences;
  for (int rank = n; rank >= 1; --rank) {
    const bool positive = rank <= plus;
    if (positive) plus -= rank;
    differences.push_back(positive ? rank : -rank);
  }
  return differences;
}

// The largest smaller sum of ranks that is significant, two-sided, for n pairs: as tables in textbooks give it.
struct Critical {
  int n, at_5_percent, at_1_percent;  ///< -1: none.
};
constexpr Critical kTable[] = {{6, 0, -1},   {7, 2, -1},   {8, 3, 0},    {9, 5, 1},    {10, 8, 3},    {11, 10, 5},
                               {12, 13, 7},  {13, 17, 9},  {14, 21, 12}, {15, 25, 15}, {16, 29, 19},  {17, 34, 23},
                               {18, 40, 27}, {19, 46, 32}, {20, 52, 37}, {25, 89, 68}, {30, 137, 109}};

TEST(SignedRank, AgreesWithPublishedCriticalValues) {
  for (const Critical& row : kTable) {
    SCOPED_TRACE(row.n);
    EXPECT_LE(signed_rank_test(differences_with_sum(row.n, row.at_5_percent)).p, 0.05);
    EXPECT_GT(signed_rank_test(differences_with_sum(row.n, row.at_5_percent + 1)).p, 0.05);
    if (row.at_1_percent >= 0) {
      EXPECT_LE(signed_rank_test(differences_with_sum(row.n, row.at_1_percent)).p, 0.01);
    }
    EXPECT_GT(signed_rank_test(differences_with_sum(row.n, row.at_1_percent + 1)).p, 0.01);
  }
}

TEST(SignedRank, ByHand) {
  // Of the 8 ways to give signs to the ranks 1, 2, 3 one has the sum 0 and one the sum 6.
  EXPECT_DOUBLE_EQ(signed_rank_test({0.1, 0.2, 0.3}).p, 0.25);
  EXPECT_DOUBLE_EQ(signed_rank_test({-0.1, -0.2, -0.3}).p, 0.25);
  const SignedRankTest mixed = signed_rank_test({3, -1, 2, 0, 4});  // Sums 9 and 1; 0, 1, 9 and 10 are as one-sided.
  EXPECT_EQ(mixed.pairs, 4u);
  EXPECT_DOUBLE_EQ(mixed.plus, 9);
  EXPECT_DOUBLE_EQ(mixed.minus, 1);
  EXPECT_DOUBLE_EQ(mixed.p, 4.0 / 16);
}

TEST(SignedRank, EqualSizesShareTheirRanks) {
  // Ranks 1.5, 1.5, 3.5, 3.5; the sums of positive ones that are at most 1.5: {}, {1.5}, {1.5'}: 3 of 16.
  const SignedRankTest test = signed_rank_test({-1, 1, 2, 2});
  EXPECT_DOUBLE_EQ(test.minus, 1.5);
  EXPECT_DOUBLE_EQ(test.plus, 8.5);
  EXPECT_DOUBLE_EQ(test.p, 6.0 / 16);
}

TEST(SignedRank, InfiniteDifferencesRankHighest) {
  const SignedRankTest test = signed_rank_test({kInfinity, kInfinity, -1});
  EXPECT_DOUBLE_EQ(test.plus, 5);
  EXPECT_DOUBLE_EQ(test.minus, 1);
}

TEST(SignedRank, NothingDiffers) {
  EXPECT_EQ(signed_rank_test({}).p, 1);
  EXPECT_EQ(signed_rank_test({0, 0}).p, 1);
  EXPECT_EQ(signed_rank_test({1, -1}).p, 1);
}

TEST(SignedRank, ApproximationContinuesTheExactProbability) {
  // Just below and just above the limit with the same share of positive ranks.
  const int below = static_cast<int>(kMostExactPairs), above = below + 1;
  const double exact = signed_rank_test(differences_with_sum(below, below * (below + 1) * 19 / 100)).p;
  const double approximate = signed_rank_test(differences_with_sum(above, above * (above + 1) * 19 / 100)).p;
  EXPECT_NEAR(exact / approximate, 1, 0.1);
  EXPECT_LT(exact, 0.05);
  EXPECT_GT(exact, 0.01);
}

}  // namespace
}  // namespace ldso
