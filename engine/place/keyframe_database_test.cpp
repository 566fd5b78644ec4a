#include "place/keyframe_database.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::size_t kWords = 500;

BowVector random_vector(std::mt19937_64& random) {
  std::vector<float> weights(kWords, 0);
  float sum = 0;
  for (int i = 0; i < 40; ++i) {
    const auto weight = static_cast<float>(random() % 7 + 1);
    weights[random() % kWords] += weight;
    sum += weight;
  }
  BowVector vector;
  for (WordId word = 0; word < kWords; ++word) {
    if (weights[word] > 0) vector.emplace_back(word, weights[word] / sum);
  }
  return vector;
}

TEST(KeyframeDatabase, FindsWhatAComparisonWithAllFinds) {
  std::mt19937_64 random(1);
  KeyframeDatabase database(kWords);
  std::vector<BowVector> vectors;
  for (int i = 0; i < 200; ++i) {
    vectors.push_back(random_vector(random));
    database.add(3 * i, vectors.back());
  }
  EXPECT_EQ(database.size(), 200u);
  for (int query = 0; query < 10; ++query) {
    const BowVector vector = query == 0 ? vectors[17] : random_vector(random);
    std::vector<PlaceCandidate> expected;
    for (int i = 0; i < 200; ++i) {
      const float s = score(vector, vectors[i]);
      if (s > 0) expected.push_back({3 * i, s});
    }
    std::stable_sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    EXPECT_EQ(database.query(vector, 1000), expected);  // Bit by bit.
    expected.resize(5);
    EXPECT_EQ(database.query(vector, 5), expected);
  }
  EXPECT_EQ(database.query(vectors[17], 1)[0].id, 3 * 17);
}

TEST(KeyframeDatabase, OfEqualScoresTheOlderComesFirst) {
  KeyframeDatabase database(kWords);
  const BowVector same{{3, 0.5F}, {9, 0.5F}};
  for (const int id : {-4, 2, 7, 100}) database.add(id, same);
  const std::vector<PlaceCandidate> all = database.query(same, 3);
  EXPECT_EQ(all, (std::vector<PlaceCandidate>{{-4, 1}, {2, 1}, {7, 1}}));
}

TEST(KeyframeDatabase, LeavesOutRefusedKeyframes) {
  KeyframeDatabase database(kWords);
  for (int id = 0; id < 10; ++id) database.add(id, {{1, 1.0F}});
  const auto found = database.query({{1, 1.0F}}, 100, [](std::int64_t id) { return id < 3; });
  EXPECT_EQ(found.size(), 3u);
  EXPECT_TRUE(database.query({{1, 1.0F}}, 100, [](std::int64_t) { return false; }).empty());
}

TEST(KeyframeDatabase, KeyframesWithoutACommonWordAreNoCandidates) {
  KeyframeDatabase database(kWords);
  database.add(0, {{1, 1.0F}});
  database.add(1, {});
  EXPECT_TRUE(database.query({{2, 1.0F}}, 10).empty());
  EXPECT_TRUE(database.query({}, 10).empty());
  EXPECT_TRUE(KeyframeDatabase(kWords).query({{2, 1.0F}}, 10).empty());
}

TEST(KeyframeDatabase, RefusesWrongUse) {
  KeyframeDatabase database(kWords);
  database.add(5, {{1, 1.0F}});
  EXPECT_THROW(database.add(5, {{1, 1.0F}}), Error);
  EXPECT_THROW(database.add(4, {{1, 1.0F}}), Error);
  EXPECT_THROW(database.add(6, {{0, 0.5F}, {kWords, 0.5F}}), Error);
  EXPECT_EQ(database.size(), 1u);
  EXPECT_EQ(database.query({{0, 1.0F}}, 10).size(), 0u);  // Nothing of a refused keyframe is left.
}

}  // namespace
}  // namespace ldso
