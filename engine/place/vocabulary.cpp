#include "place/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ldso/error.h"

namespace ldso {
namespace {

/// What an error of a vocabulary suggests.
constexpr const char* kRemedy = "train the vocabulary again or take another file";

/// Indices of the nodes by parent: those of parent p are list[begin[p]] .. list[begin[p + 1] - 1], in their order.
struct ChildLists {
  std::vector<std::uint32_t> begin, list;
};

ChildLists child_lists(std::span<const VocabularyNode> nodes) {
  ChildLists lists;
  lists.begin.assign(nodes.size() + 1, 0);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].parent >= nodes.size())
      throw Error("vocabulary", "node " + std::to_string(i) + " hangs on a node that does not exist", kRemedy);
    ++lists.begin[nodes[i].parent + 1];
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) lists.begin[i + 1] += lists.begin[i];
  std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  lists.list.resize(nodes.empty() ? 0 : nodes.size() - 1);
  for (std::size_t i = 1; i < nodes.size(); ++i) lists.list[next[nodes[i].parent]++] = static_cast<std::uint32_t>(i);
  return lists;
}

}  // namespace

float score(const BowVector& a, const BowVector& b) {
  float sum = 0;
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() && j != b.end()) {
    if (i->first < j->first) {
      ++i;
    } else if (j->first < i->first) {
      ++j;
    } else {
      // Both sum to 1, so 1 - |a - b| / 2 is the sum of the smaller ones.
      sum += std::min(i++->second, j++->second);
    }
  }
  return sum;
}

Vocabulary::Vocabulary(std::span<const VocabularyNode> nodes, std::string origin) : origin_(std::move(origin)) {
  if (nodes.size() < 2) throw Error("vocabulary", "it has no word", kRemedy);
  const ChildLists lists = child_lists(nodes);
  std::vector<std::uint32_t> order{0};  // Breadth first; new number -> index in `nodes`.
  order.reserve(nodes.size());
  descriptors_.reserve(nodes.size());
  parents_.assign(1, 0);
  level_begin_ = {0, 1};
  for (NodeId node = 0; node < order.size(); ++node) {
    if (node == level_begin_.back()) level_begin_.push_back(static_cast<NodeId>(order.size()));
    const std::uint32_t index = order[node], begin = lists.begin[index], end = lists.begin[index + 1];
    descriptors_.push_back(nodes[index].descriptor);
    first_child_.push_back(static_cast<NodeId>(order.size()));
    node_words_.push_back(static_cast<WordId>(weights_.size()));
    branching_ = std::max(branching_, static_cast<int>(end - begin));
    order.insert(order.end(), lists.list.begin() + begin, lists.list.begin() + end);
    parents_.insert(parents_.end(), end - begin, node);
    if (begin != end) continue;
    if (!std::isfinite(nodes[index].weight) || nodes[index].weight < 0)
      throw Error("vocabulary", "the weight of node " + std::to_string(index) + " is no number from 0 on", kRemedy);
    word_nodes_.push_back(node);
    weights_.push_back(nodes[index].weight);
  }
  first_child_.push_back(static_cast<NodeId>(order.size()));
  if (order.size() != nodes.size()) throw Error("vocabulary", "its nodes are no tree below node 0", kRemedy);
  if (depth() > kMaxDepth) throw Error("vocabulary", "it is deeper than " + std::to_string(kMaxDepth), kRemedy);
}

WordId Vocabulary::word(const OrbDescriptor& descriptor) const {
  NodeId node = 0;
  for (auto [child, end] = children(0); child != end; std::tie(child, end) = children(node)) {
    int least = 257;
    for (; child != end; ++child) {
      const int distance = hamming_distance(descriptor, descriptors_[child]);
      if (distance >= least) continue;
      least = distance;
      node = child;
    }
  }
  return node_words_[node];
}

std::vector<WordId> Vocabulary::words(std::span<const Feature> features) const {
  std::vector<WordId> words;
  words.reserve(features.size());
  for (const Feature& feature : features) words.push_back(word(feature.descriptor));
  return words;
}

BowVector Vocabulary::bow_vector(std::span<const WordId> words) const {
  std::vector<WordId> sorted(words.begin(), words.end());
  std::sort(sorted.begin(), sorted.end());
  BowVector vector;
  double sum = 0;
  for (const WordId word : sorted) {
    const float weight = weights_[word];
    if (weight <= 0) continue;
    if (vector.empty() || vector.back().first != word) vector.emplace_back(word, 0.0F);
    vector.back().second += weight;
    sum += weight;
  }
  for (auto& [word, weight] : vector) weight = static_cast<float>(weight / sum);
  return vector;
}

NodeId Vocabulary::node_at_level(WordId word, int level) const {
  NodeId node = word_nodes_[word];
  if (level >= depth()) return node;
  while (node >= level_begin_[static_cast<std::size_t>(std::max(level, 0)) + 1]) node = parents_[node];
  return node;
}

}  // namespace ldso
