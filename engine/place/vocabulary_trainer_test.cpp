#include "place/vocabulary_trainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ldso/error.h"
#include "place/test_descriptors.h"
#include "place/vocabulary_file.h"

namespace ldso {
namespace {

using place_test::features_of;
using place_test::made_up_images;

TrainingOptions small_options() {
  TrainingOptions options;
  options.branching = 6;
  options.depth = 4;
  return options;
}

TEST(VocabularyTrainer, RecognizesPlaces) {
  constexpr int kPlaces = 15;
  const auto images = made_up_images(60, kPlaces);
  ThreadPool pool(2);
  const Vocabulary vocabulary = train_vocabulary(std::span(images).first(30), small_options(), pool);
  std::vector<BowVector> vectors;
  for (const auto& image : images) vectors.push_back(vocabulary.transform(features_of(image)));
  // Images 30..59 are new views of the places.
  for (int i = 30; i < 60; ++i) {
    float same = 1, other = 0;
    for (int j = 0; j < 30; ++j) {
      float& side = j % kPlaces == i % kPlaces ? same : other;
      side = &side == &same ? std::min(side, score(vectors[i], vectors[j]))
                            : std::max(side, score(vectors[i], vectors[j]));
    }
    EXPECT_GT(same, 2 * other) << "image " << i;
  }
}

TEST(VocabularyTrainer, SameResultForAnyNumberOfThreads) {
  // The root has more than the 16384 descriptors from which on threads share a node.
  auto images = made_up_images(300, 40);
  TrainingOptions options = small_options();
  options.iterations = 3;
  std::vector<std::uint8_t> expected;
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    const std::vector<std::uint8_t> bytes = vocabulary_bytes(train_vocabulary(images, options, pool));
    if (expected.empty()) expected = bytes;
    EXPECT_EQ(bytes, expected) << threads << " threads";
  }
  ThreadPool pool(2);
  options.seed = 2;
  EXPECT_NE(vocabulary_bytes(train_vocabulary(images, options, pool)), expected);
}

TEST(VocabularyTrainer, KeepsToBranchingAndDepth) {
  const auto images = made_up_images(30, 30);
  ThreadPool pool(1);
  for (const auto& [branching, depth] : {std::pair(2, 3), std::pair(5, 2), std::pair(255, 1)}) {
    TrainingOptions options;
    options.branching = branching;
    options.depth = depth;
    const Vocabulary vocabulary = train_vocabulary(images, options, pool);
    EXPECT_EQ(vocabulary.depth(), depth);
    EXPECT_LE(vocabulary.branching(), branching);
    EXPECT_GT(vocabulary.word_count(), 0.9 * std::pow(branching, depth));
  }
}

TEST(VocabularyTrainer, SmallNodesAreNotDivided) {
  const auto images = made_up_images(30, 30);  // 1800 descriptors.
  ThreadPool pool(1);
  TrainingOptions options;
  options.depth = 8;
  const std::size_t all = train_vocabulary(images, options, pool).word_count();
  options.least_descriptors = 20;
  const std::size_t fewer = train_vocabulary(images, options, pool).word_count();
  EXPECT_GT(all, 1500u);
  EXPECT_LT(fewer, all / 2);
}

TEST(VocabularyTrainer, WeightIsTheInverseDocumentFrequency) {
  std::mt19937_64 random(6);
  const OrbDescriptor everywhere = place_test::random_descriptor(random),
                      seldom = place_test::random_descriptor(random);
  std::vector<std::vector<OrbDescriptor>> images(8, {everywhere, everywhere});
  images[3].push_back(seldom);
  images[5].push_back(seldom);
  images[5].push_back(seldom);
  ThreadPool pool(1);
  const Vocabulary vocabulary = train_vocabulary(images, {}, pool);
  ASSERT_EQ(vocabulary.word_count(), 2u);
  EXPECT_FLOAT_EQ(vocabulary.weight(vocabulary.word(everywhere)), 0);
  EXPECT_FLOAT_EQ(vocabulary.weight(vocabulary.word(seldom)), std::log(8.0F / 2));
}

TEST(VocabularyTrainer, TellsItsProgress) {
  const auto images = made_up_images(30, 30);
  ThreadPool pool(2);
  std::vector<double> told;
  TrainingOptions options = small_options();
  options.origin = "made up";
  const Vocabulary vocabulary = train_vocabulary(images, options, pool, [&](double done) { told.push_back(done); });
  EXPECT_GE(told.size(), 5u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0);
  EXPECT_EQ(told.back(), 1);
  EXPECT_EQ(vocabulary.origin(), "made up; 30 images, 1800 descriptors");
}

TEST(VocabularyTrainer, RefusesImpossibleInput) {
  const auto images = made_up_images(5, 5);
  ThreadPool pool(1);
  const auto refused = [&](auto change) {
    TrainingOptions options;
    change(options);
    EXPECT_THROW(train_vocabulary(images, options, pool), Error);
  };
  refused([](TrainingOptions& o) { o.branching = 1; });
  refused([](TrainingOptions& o) { o.branching = 256; });
  refused([](TrainingOptions& o) { o.depth = 0; });
  refused([](TrainingOptions& o) { o.depth = Vocabulary::kMaxDepth + 1; });
  refused([](TrainingOptions& o) { o.iterations = 0; });
  refused([](TrainingOptions& o) { o.least_descriptors = 1; });
  EXPECT_THROW(train_vocabulary({}, {}, pool), Error);
  EXPECT_THROW(train_vocabulary(std::span(images).first(1), {}, pool), Error);
  const std::vector<std::vector<OrbDescriptor>> no_descriptors(3), one(3, {OrbDescriptor{}});
  EXPECT_THROW(train_vocabulary(no_descriptors, {}, pool), Error);
  EXPECT_THROW(train_vocabulary(one, {}, pool), Error);
}

}  // namespace
}  // namespace ldso
