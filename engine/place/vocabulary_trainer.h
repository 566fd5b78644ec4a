#pragma once

// Makes a vocabulary of the descriptors of training images: k-majority clustering, level after level (Grana,
// Borghesani, Manfredi, Cucchiara: A fast approach for integrating ORB descriptors in the bag of words model, SPIE
// 2013), seeded as k-means++ (Arthur, Vassilvitskii, SODA 2007).

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "place/vocabulary.h"
#include "util/thread_pool.h"

namespace ldso {

struct TrainingOptions {
  int branching = 10;         ///< Children of a node, 2..255.
  int depth = 5;              ///< Levels below the root, 1..Vocabulary::kMaxDepth: at most branching^depth words.
  int iterations = 12;        ///< Of the clustering of a node, at most; it ends earlier where nothing moves any more.
  int least_descriptors = 2;  ///< A node of fewer training descriptors is not divided any further.
  std::uint64_t seed = 1;     ///< Of the random choices.
  std::string origin;         ///< See Vocabulary; the numbers of images and descriptors are appended.
};

/// Called with the part that is done, 0..1, on the calling thread.
using TrainingProgress = std::function<void(double done)>;

/// `images`: the descriptors of each training image; a word's weight is log(images / images with the word). The result
/// depends on images and options alone, not on the number of threads. Throws Error if an option is out of range or if
/// there are fewer than two different descriptors.
Vocabulary train_vocabulary(std::span<const std::vector<OrbDescriptor>> images, const TrainingOptions& options,
                            ThreadPool& pool, const TrainingProgress& progress = {});

}  // namespace ldso
