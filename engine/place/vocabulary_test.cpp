#include "place/vocabulary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "ldso/error.h"
#include "place/test_descriptors.h"

namespace ldso {
namespace {

using place_test::features_of;
using place_test::random_descriptor;

OrbDescriptor bits(std::uint64_t first) { return {{first, 0, 0, 0}}; }

/// Root with children A (inner), B (word); A with the words A0, A1. Listed in an order that is not breadth-first:
/// root, A, A0, B, A1.
std::vector<VocabularyNode> small_tree() {
  return {{0, 0, {}}, {0, 0, bits(0x00ff)}, {1, 2, bits(0x000f)}, {0, 1, bits(0xff00)}, {1, 0.5F, bits(0x00f0)}};
}

TEST(Vocabulary, NumbersItsNodesLevelByLevel) {
  const Vocabulary vocabulary(small_tree(), "by hand");
  EXPECT_EQ(vocabulary.node_count(), 5u);
  EXPECT_EQ(vocabulary.word_count(), 3u);
  EXPECT_EQ(vocabulary.depth(), 2);
  EXPECT_EQ(vocabulary.branching(), 2);
  EXPECT_EQ(vocabulary.origin(), "by hand");
  EXPECT_EQ(vocabulary.children(0), (std::pair<NodeId, NodeId>(1, 3)));
  EXPECT_EQ(vocabulary.children(1), (std::pair<NodeId, NodeId>(3, 5)));
  EXPECT_EQ(vocabulary.children(2), (std::pair<NodeId, NodeId>(5, 5)));
  EXPECT_EQ(vocabulary.descriptor(2), bits(0xff00));
  EXPECT_EQ(vocabulary.weight(0), 1);  // B comes first: it is higher up.
  EXPECT_EQ(vocabulary.weight(1), 2);
  EXPECT_EQ(vocabulary.weight(2), 0.5F);
}

TEST(Vocabulary, FindsWordsAndTheirAncestors) {
  const Vocabulary vocabulary(small_tree());
  EXPECT_EQ(vocabulary.word(bits(0xff00)), 0u);
  EXPECT_EQ(vocabulary.word(bits(0x000e)), 1u);
  EXPECT_EQ(vocabulary.word(bits(0x00f1)), 2u);
  EXPECT_EQ(vocabulary.word(bits(0)), 1u);  // Equally near to all: the first each time.
  EXPECT_EQ(vocabulary.node_at_level(2, 0), 0u);
  EXPECT_EQ(vocabulary.node_at_level(2, 1), 1u);
  EXPECT_EQ(vocabulary.node_at_level(2, 2), 4u);
  EXPECT_EQ(vocabulary.node_at_level(2, 99), 4u);
  EXPECT_EQ(vocabulary.node_at_level(2, -1), 0u);
  EXPECT_EQ(vocabulary.node_at_level(0, 1), 2u);
  EXPECT_EQ(vocabulary.node_at_level(0, 2), 2u);  // A word higher up stands for itself.
}

TEST(Vocabulary, WeighsWordsByFrequency) {
  const Vocabulary vocabulary(small_tree());
  const BowVector vector = vocabulary.transform(features_of({bits(0x000f), bits(0xff00), bits(0x000f), bits(0x00f0)}));
  // Twice weight 2, once 1, once 0.5.
  ASSERT_EQ(vector.size(), 3u);
  EXPECT_EQ(vector[0].first, 0u);
  EXPECT_NEAR(vector[0].second, 1 / 5.5, 1e-6);
  EXPECT_NEAR(vector[1].second, 4 / 5.5, 1e-6);
  EXPECT_NEAR(vector[2].second, 0.5 / 5.5, 1e-6);
  EXPECT_TRUE(vocabulary.transform({}).empty());
}

TEST(Vocabulary, LeavesOutWordsWithoutWeight) {
  std::vector<VocabularyNode> nodes = small_tree();
  nodes[3].weight = 0;
  const Vocabulary vocabulary(nodes);
  EXPECT_TRUE(vocabulary.transform(features_of({bits(0xff00), bits(0xff00)})).empty());
}

TEST(Vocabulary, ScoreIsOneMinusHalfTheL1Distance) {
  std::mt19937_64 random(3);
  const auto random_vector = [&] {
    BowVector vector;
    float sum = 0;
    for (WordId word = 0; word < 40; ++word) {
      if (random() % 2 == 0) continue;
      vector.emplace_back(word, static_cast<float>(random() % 1000 + 1));
      sum += vector.back().second;
    }
    for (auto& [word, weight] : vector) weight /= sum;
    return vector;
  };
  for (int i = 0; i < 20; ++i) {
    const BowVector a = random_vector(), b = random_vector();
    std::vector<double> difference(40, 0);
    for (const auto& [word, weight] : a) difference[word] += weight;
    for (const auto& [word, weight] : b) difference[word] -= weight;
    double distance = 0;
    for (const double d : difference) distance += std::abs(d);
    EXPECT_NEAR(score(a, b), 1 - distance / 2, 1e-5);
    EXPECT_EQ(score(a, b), score(b, a));
    EXPECT_NEAR(score(a, a), 1, 1e-5);
  }
  EXPECT_EQ(score({{1, 1.0F}}, {{2, 1.0F}}), 0);
  EXPECT_EQ(score({}, {{2, 1.0F}}), 0);
}

TEST(Vocabulary, RefusesWhatIsNoTree) {
  const auto refused = [](std::vector<VocabularyNode> nodes) { EXPECT_THROW(Vocabulary{nodes}, Error); };
  refused({});
  refused({{0, 0, {}}});
  std::vector<VocabularyNode> nodes = small_tree();
  nodes[2].parent = 17;
  refused(nodes);
  nodes = small_tree();
  nodes[1].parent = 2;  // Two nodes that hang on each other.
  refused(nodes);
  for (const float weight : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    nodes = small_tree();
    nodes[4].weight = weight;
    refused(nodes);
  }
  nodes.assign(1, {});
  for (std::uint32_t i = 0; i <= Vocabulary::kMaxDepth; ++i) nodes.push_back({i, 1, {}});
  refused(nodes);
  nodes.pop_back();
  EXPECT_EQ(Vocabulary(nodes).depth(), Vocabulary::kMaxDepth);
}

TEST(Vocabulary, WordIsTheEndOfAGreedyDescent) {
  std::mt19937_64 random(5);
  std::vector<VocabularyNode> nodes(1);
  for (std::uint32_t parent = 0; nodes.size() < 400; ++parent) {
    for (int i = 0; i < 5; ++i) nodes.push_back({parent, 1, random_descriptor(random)});
  }
  const Vocabulary vocabulary(nodes);
  for (int i = 0; i < 50; ++i) {
    const OrbDescriptor descriptor = random_descriptor(random);
    NodeId node = 0;
    int level = 0;
    const WordId word = vocabulary.word(descriptor);
    while (vocabulary.children(node).first != vocabulary.children(node).second) {
      const auto [begin, end] = vocabulary.children(node);
      int least = 257;
      for (NodeId child = begin; child < end; ++child) {
        const int distance = hamming_distance(descriptor, vocabulary.descriptor(child));
        if (distance < least) node = child;
        least = std::min(least, distance);
      }
      EXPECT_EQ(vocabulary.node_at_level(word, ++level), node);
    }
    EXPECT_EQ(vocabulary.node_at_level(word, vocabulary.depth()), node);
  }
}

}  // namespace
}  // namespace ldso
