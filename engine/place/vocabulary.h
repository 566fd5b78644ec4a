#pragma once

// A visual vocabulary: a tree that sorts descriptors into words, so that images can be compared by the words they share
// (Nister, Stewenius: Scalable recognition with a vocabulary tree, CVPR 2006; binary: Galvez-Lopez, Tardos: Bags of
// binary words, T-RO 2012).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "place/feature.h"

namespace ldso {

using WordId = std::uint32_t;  ///< 0 .. word_count() - 1.
using NodeId = std::uint32_t;  ///< 0 (root) .. node_count() - 1, levels one after the other.

/// The words of an image with their weights (tf-idf), which are positive and sum to 1; rising words.
using BowVector = std::vector<std::pair<WordId, float>>;

/// L1 score of two images, 1 - |a - b| / 2: 0 (no common word) to 1 (the same words).
float score(const BowVector& a, const BowVector& b);

/// What a tree is made of.
struct VocabularyNode {
  std::uint32_t parent = 0;  ///< Index in the list of nodes; that of node 0, the root, is not read.
  float weight = 0;          ///< Inverse document frequency, of leaves.
  OrbDescriptor descriptor;  ///< Centre of the descriptors below; the root's is not read.
};

/// Immutable, so that threads may share one.
class Vocabulary {
 public:
  /// `nodes` in any order but for the root, which comes first. `origin` says in a line where it comes from. Throws
  /// Error if they are no tree, if there is no word, if a leaf's weight is negative or not finite, or if it is deeper
  /// than kMaxDepth.
  explicit Vocabulary(std::span<const VocabularyNode> nodes, std::string origin = {});

  /// Far deeper than any vocabulary: one of ten children a node has 1e6 words at depth 6.
  static constexpr int kMaxDepth = 32;

  /// The word of a descriptor: down from the root, each time to the nearest child (of equally near ones the first).
  WordId word(const OrbDescriptor& descriptor) const;
  std::vector<WordId> words(std::span<const Feature> features) const;

  /// The words of an image and their weights; words without weight are left out.
  BowVector bow_vector(std::span<const WordId> words) const;
  BowVector transform(std::span<const Feature> features) const { return bow_vector(words(features)); }

  /// The word's ancestor on a level (0: root, 1: below it, ...); its own node if that lies no deeper. Descriptors of
  /// the same corner often differ in the word but seldom in an ancestor: matching is confined to features of the same
  /// one.
  NodeId node_at_level(WordId word, int level) const;

  std::size_t word_count() const { return weights_.size(); }
  std::size_t node_count() const { return descriptors_.size(); }
  int depth() const { return static_cast<int>(level_begin_.size()) - 2; }  ///< Level of the deepest word.
  int branching() const { return branching_; }                             ///< Greatest number of children of a node.
  const std::string& origin() const { return origin_; }

  /// Children of a node: nodes first .. second - 1; words have none.
  std::pair<NodeId, NodeId> children(NodeId node) const { return {first_child_[node], first_child_[node + 1]}; }
  const OrbDescriptor& descriptor(NodeId node) const { return descriptors_[node]; }
  float weight(WordId word) const { return weights_[word]; }

 private:
  // Nodes lie in breadth-first order: siblings are neighbours, and the children of a node end where those of the next
  // begin.
  std::vector<OrbDescriptor> descriptors_;
  std::vector<NodeId> first_child_;  ///< Of each node, and one more.
  std::vector<NodeId> parents_;
  std::vector<WordId> node_words_;  ///< Word of each node that is one.
  std::vector<NodeId> word_nodes_;
  std::vector<float> weights_;       ///< Of the words.
  std::vector<NodeId> level_begin_;  ///< First node of each level, and one more.
  int branching_ = 0;
  std::string origin_;
};

}  // namespace ldso
