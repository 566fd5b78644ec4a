#include "place/vocabulary_trainer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ldso/error.h"
#include "place/k_majority.h"
#include "util/hash.h"

namespace ldso {
namespace {

constexpr std::uint32_t kLargeNode = 1 << 14;  ///< From so many descriptors on threads share a node.

struct Range {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t size() const { return end - begin; }
};

struct TreeNode {
  VocabularyNode node;
  Range range;  ///< Its training descriptors.
};

/// A node's seed depends on its place in the tree alone.
std::uint64_t node_seed(std::uint64_t seed, std::uint64_t node) { return splitmix_output(seed * kSplitMixStep + node); }

class Trainer {
 public:
  Trainer(std::span<const std::vector<OrbDescriptor>> images, const TrainingOptions& options, ThreadPool& pool,
          const TrainingProgress& progress)
      : options_(options), pool_(pool), progress_(progress), images_(static_cast<std::uint32_t>(images.size())) {
    std::size_t count = 0;
    for (const auto& image : images) count += image.size();
    if (count > std::numeric_limits<std::int32_t>::max())
      throw Error("vocabulary training", "too many descriptors", "take fewer images or features per image");
    for (std::uint32_t i = 0; i < images.size(); ++i) {
      descriptors_.insert(descriptors_.end(), images[i].begin(), images[i].end());
      image_of_.insert(image_of_.end(), images[i].size(), i);
    }
  }

  Vocabulary train() {
    tree_.push_back({{}, {0, static_cast<std::uint32_t>(descriptors_.size())}});
    std::size_t level_begin = 0;
    for (level_ = 0; level_ < options_.depth && level_begin < tree_.size(); ++level_) {
      const std::size_t level_end = tree_.size();
      divide_level(level_begin, level_end);
      level_begin = level_end;
    }
    if (tree_.size() < 2)
      throw Error("vocabulary training", "fewer than two different descriptors", "take images with more texture");
    if (progress_) progress_(1);
    return Vocabulary(weighted_nodes(), options_.origin + (options_.origin.empty() ? "" : "; ") +
                                            std::to_string(images_) + " images, " +
                                            std::to_string(descriptors_.size()) + " descriptors");
  }

 private:
  /// Large nodes one after the other, each by all threads; of the small ones each by one thread.
  void divide_level(std::size_t begin, std::size_t end) {
    std::vector<std::vector<TreeNode>> children(end - begin);
    std::vector<std::size_t> small;
    std::uint64_t done = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (tree_[i].range.size() < kLargeNode) {
        small.push_back(i);
        continue;
      }
      children[i - begin] = divide(i, &pool_);
      report(done += tree_[i].range.size());
    }
    // In batches, so that progress can be told.
    const std::size_t batch = std::max<std::size_t>(small.size() / 20, 64);
    for (std::size_t first = 0; first < small.size(); first += batch) {
      const std::size_t count = std::min(batch, small.size() - first);
      pool_.run(static_cast<int>(count), [&](int chunk) {
        const std::size_t i = small[first + static_cast<std::size_t>(chunk)];
        children[i - begin] = divide(i, nullptr);
      });
      for (std::size_t i = first; i < first + count; ++i) done += tree_[small[i]].range.size();
      report(done);
    }
    for (const std::vector<TreeNode>& siblings : children) tree_.insert(tree_.end(), siblings.begin(), siblings.end());
  }

  /// The children of a node; none if it stays a word. Sorts its descriptors by child.
  std::vector<TreeNode> divide(std::size_t index, ThreadPool* pool) {
    const Range range = tree_[index].range;
    if (range.size() < static_cast<std::uint32_t>(options_.least_descriptors)) return {};
    const Clusters clusters =
        cluster_descriptors(std::span(descriptors_).subspan(range.begin, range.size()), options_.branching,
                            options_.iterations, node_seed(options_.seed, index), pool);
    if (clusters.centers.size() < 2) return {};
    std::vector<TreeNode> children;
    std::vector<std::uint32_t> next(clusters.centers.size() + 1, 0);
    for (const std::uint8_t cluster : clusters.cluster_of) ++next[cluster + 1];
    for (std::size_t i = 0; i < clusters.centers.size(); ++i) {
      next[i + 1] += next[i];
      children.push_back({{static_cast<std::uint32_t>(index), 0, clusters.centers[i]},
                          {range.begin + next[i], range.begin + next[i + 1]}});
    }
    sort_by_cluster(range, clusters.cluster_of, std::move(next));
    return children;
  }

  /// `next`: where the descriptors of each cluster go, from the range's beginning.
  void sort_by_cluster(Range range, const std::vector<std::uint8_t>& cluster_of, std::vector<std::uint32_t> next) {
    const std::vector<OrbDescriptor> descriptors(descriptors_.begin() + range.begin, descriptors_.begin() + range.end);
    const std::vector<std::uint32_t> image_of(image_of_.begin() + range.begin, image_of_.begin() + range.end);
    for (std::size_t i = 0; i < cluster_of.size(); ++i) {
      const std::uint32_t target = range.begin + next[cluster_of[i]]++;
      descriptors_[target] = descriptors[i];
      image_of_[target] = image_of[i];
    }
  }

  std::vector<VocabularyNode> weighted_nodes() const {
    std::vector<bool> is_word(tree_.size(), true);
    for (std::size_t i = 1; i < tree_.size(); ++i) is_word[tree_[i].node.parent] = false;
    std::vector<VocabularyNode> nodes;
    nodes.reserve(tree_.size());
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      nodes.push_back(tree_[i].node);
      if (is_word[i]) nodes.back().weight = inverse_document_frequency(tree_[i].range);
    }
    return nodes;
  }

  float inverse_document_frequency(Range range) const {
    std::vector<std::uint32_t> images(image_of_.begin() + range.begin, image_of_.begin() + range.end);
    std::sort(images.begin(), images.end());
    const auto with_word = static_cast<double>(std::unique(images.begin(), images.end()) - images.begin());
    return static_cast<float>(std::log(images_ / with_word));
  }

  void report(std::uint64_t done_of_level) const {
    if (!progress_) return;
    const double level_done = static_cast<double>(done_of_level) / static_cast<double>(descriptors_.size());
    progress_(std::min((level_ + level_done) / options_.depth, 1.0));
  }

  const TrainingOptions& options_;
  ThreadPool& pool_;
  const TrainingProgress& progress_;
  std::uint32_t images_;
  std::vector<OrbDescriptor> descriptors_;  ///< Sorted by node as far as the tree goes.
  std::vector<std::uint32_t> image_of_;     ///< Of each descriptor.
  std::vector<TreeNode> tree_;
  int level_ = 0;
};

void check(bool good, const std::string& option, const std::string& remedy) {
  if (!good) throw Error("vocabulary training", option + " is out of range", remedy);
}

}  // namespace

Vocabulary train_vocabulary(std::span<const std::vector<OrbDescriptor>> images, const TrainingOptions& options,
                            ThreadPool& pool, const TrainingProgress& progress) {
  if (images.size() < 2)
    throw Error("vocabulary training", "a word's weight is how few images have it, which takes at least two images",
                "take more images");
  check(options.branching >= 2 && options.branching <= 255, "the branching", "take 2..255");
  check(options.depth >= 1 && options.depth <= Vocabulary::kMaxDepth, "the depth",
        "take 1.." + std::to_string(Vocabulary::kMaxDepth));
  check(options.iterations >= 1, "the number of iterations", "take at least 1");
  check(options.least_descriptors >= 2, "the least number of descriptors", "take at least 2");
  return Trainer(images, options, pool, progress).train();
}

}  // namespace ldso
