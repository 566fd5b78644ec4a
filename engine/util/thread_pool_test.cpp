#include "util/thread_pool.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

namespace ldso {
namespace {

float chunked_sum(int threads, const std::vector<float>& values) {
  ThreadPool pool(threads);
  constexpr int kChunk = 64;
  const int count = static_cast<int>(values.size());
  std::vector<float> sums(ThreadPool::chunk_count(count, kChunk), 0.0f);
  pool.for_chunks(count, kChunk, [&](int chunk, int begin, int end) {
    for (int i = begin; i < end; ++i) sums[chunk] += values[i];
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0f);
}

TEST(ThreadPool, ReductionIsBitIdenticalForAnyNumberOfThreads) {
  std::vector<float> values;
  for (int i = 0; i < 10007; ++i) values.push_back(1.0f / static_cast<float>(1 + i * 7919 % 10007));
  const float expected = chunked_sum(1, values);
  for (const int threads : {2, 3, 4}) {
    for (int repetition = 0; repetition < 20; ++repetition) EXPECT_EQ(chunked_sum(threads, values), expected);
  }
}

TEST(ThreadPool, RethrowsTheErrorOfATaskAndStaysUsable) {
  ThreadPool pool(3);
  const auto failing = [](int chunk) {
    if (chunk == 5) throw std::runtime_error("chunk 5");
  };
  EXPECT_THROW(pool.run(16, failing), std::runtime_error);
  std::vector<int> hits(100, 0);
  pool.run(100, [&](int chunk) { ++hits[chunk]; });
  EXPECT_EQ(std::accumulate(hits.begin(), hits.end(), 0), 100);
}

TEST(ThreadPool, MayGrowBetweenLoops) {
  ThreadPool pool(1);
  std::vector<int> hits(1000, 0);
  const auto hit = [&](int chunk) { ++hits[chunk]; };
  pool.run(1000, hit);
  pool.grow(3);
  EXPECT_EQ(pool.threads(), 3);
  for (int loop = 0; loop < 50; ++loop) pool.run(1000, hit);
  EXPECT_EQ(hits, std::vector<int>(1000, 51));
}

TEST(ThreadPool, NoWorkReturnsAtOnce) {
  ThreadPool pool(2);
  pool.for_chunks(0, 10, [](int, int, int) { FAIL(); });
}

}  // namespace
}  // namespace ldso
