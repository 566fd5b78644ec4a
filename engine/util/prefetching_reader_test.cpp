#include "util/prefetching_reader.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>

namespace ldso {
namespace {

TEST(PrefetchingReader, HandsOverInOrder) {
  PrefetchingReader<int> reader(
      100, [](int i) { return i * i; }, 3);
  for (int i = 0; i < 100; ++i) {
    const auto item = reader.next();
    ASSERT_TRUE(item.has_value());
    EXPECT_EQ(item->index, i);
    EXPECT_EQ(item->value, i * i);
  }
  EXPECT_FALSE(reader.next().has_value());
  EXPECT_FALSE(reader.next().has_value());
}

TEST(PrefetchingReader, WorksAheadOfItsUserButNotWithoutBound) {
  std::atomic<int> produced{0};
  PrefetchingReader<int> reader(
      50, [&](int i) { return ++produced, i; }, 4);
  while (produced < 5) std::this_thread::yield();  // Four wait in the queue, one for room in it.
  for (int i = 0; i < 1000; ++i) std::this_thread::yield();
  EXPECT_EQ(produced, 5);
  reader.next();
  while (produced < 6) std::this_thread::yield();
  EXPECT_LE(produced, 6);
}

TEST(PrefetchingReader, AFailedItemCarriesItsReasonAndTheRestFollows) {
  PrefetchingReader<int> reader(3, [](int i) { return i == 1 ? throw std::runtime_error("broken") : i; });
  EXPECT_EQ(reader.next()->value, 0);
  const auto failed = reader.next();
  EXPECT_FALSE(failed->value.has_value());
  EXPECT_EQ(failed->error, "broken");
  EXPECT_EQ(failed->index, 1);
  EXPECT_EQ(reader.next()->value, 2);
  EXPECT_FALSE(reader.next().has_value());
}

TEST(PrefetchingReader, WantOfMemoryIsNoBadFrame) {
  PrefetchingReader<int> reader(3, [](int i) { return i == 1 ? throw std::bad_alloc() : i; });
  EXPECT_EQ(reader.next()->value, 0);
  try {
    reader.next();
    FAIL() << "it went on";
  } catch (const OutOfMemory& error) {
    EXPECT_NE(std::string(error.what()).find("reading frame 1"), std::string::npos) << error.what();
  }
}

TEST(PrefetchingReader, StopsWhenItIsDestroyed) {
  std::atomic<int> produced{0};
  {
    PrefetchingReader<int> reader(
        1 << 30, [&](int i) { return ++produced, i; }, 2);
    reader.next();
  }
  EXPECT_LE(produced, 5);
}

TEST(PrefetchingReader, TakesTypesThatCanOnlyBeMoved) {
  PrefetchingReader<std::unique_ptr<int>> reader(2, [](int i) { return std::make_unique<int>(i); });
  EXPECT_EQ(**reader.next()->value, 0);
  EXPECT_EQ(**reader.next()->value, 1);
}

TEST(PrefetchingReader, OfNothingEndsAtOnce) {
  PrefetchingReader<int> reader(0, [](int i) { return i; });
  EXPECT_FALSE(reader.next().has_value());
}

}  // namespace
}  // namespace ldso
