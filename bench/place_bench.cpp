// Place recognition of one keyframe: description of its corners, words, query among many keyframes.

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "place/default_vocabulary.h"
#include "place/keyframe_database.h"
#include "place/orb_descriptor.h"
#include "place/vocabulary_file.h"

namespace ldso {
namespace {

constexpr int kWidth = 640, kHeight = 480, kCorners = 500, kKeyframes = 5000;

Image<Texel> noise_image() {
  std::mt19937 random(1);
  Image<Texel> image(kWidth, kHeight);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = {static_cast<float>(random() % 256), 0, 0, 1};
  return image;
}

std::vector<Eigen::Vector2f> random_corners() {
  std::mt19937 random(2);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < kCorners; ++i) {
    const auto x = random() % (kWidth - 40), y = random() % (kHeight - 40);
    corners.emplace_back(20.0F + static_cast<float>(x), 20.0F + static_cast<float>(y));
  }
  return corners;
}

/// Descriptors as they occur: those of the vocabulary's words, disturbed.
std::vector<Feature> random_features(const Vocabulary& vocabulary, std::mt19937_64& random) {
  std::vector<Feature> features(kCorners);
  for (Feature& feature : features) {
    feature.descriptor = vocabulary.descriptor(1 + static_cast<NodeId>(random() % (vocabulary.node_count() - 1)));
    for (int i = 0; i < 20; ++i) feature.descriptor.bits[random() % 4] ^= std::uint64_t{1} << (random() % 64);
  }
  return features;
}

void describe_keyframe(benchmark::State& state) {
  const Image<Texel> image = noise_image();
  const std::vector<Eigen::Vector2f> corners = random_corners();
  for (auto _ : state) benchmark::DoNotOptimize(describe(image, corners));
}
BENCHMARK(describe_keyframe)->Unit(benchmark::kMicrosecond);

void transform_keyframe(benchmark::State& state) {
  const Vocabulary vocabulary = default_vocabulary();
  std::mt19937_64 random(3);
  const std::vector<Feature> features = random_features(vocabulary, random);
  for (auto _ : state) benchmark::DoNotOptimize(vocabulary.transform(features));
}
BENCHMARK(transform_keyframe)->Unit(benchmark::kMicrosecond);

void query_among_5000_keyframes(benchmark::State& state) {
  const Vocabulary vocabulary = default_vocabulary();
  std::mt19937_64 random(4);
  KeyframeDatabase database(vocabulary.word_count());
  for (int i = 0; i < kKeyframes; ++i) database.add(i, vocabulary.transform(random_features(vocabulary, random)));
  const BowVector vector = vocabulary.transform(random_features(vocabulary, random));
  for (auto _ : state) benchmark::DoNotOptimize(database.query(vector, 10));
}
BENCHMARK(query_among_5000_keyframes)->Unit(benchmark::kMicrosecond);

void load_default_vocabulary(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(default_vocabulary());
}
BENCHMARK(load_default_vocabulary)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ldso
