#include "util/bounded_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace ldso {
namespace {

TEST(BoundedQueue, HandsItemsOverInOrder) {
  BoundedQueue<int> queue(2);
  std::jthread producer([&queue] {
    for (int i = 0; i < 1000; ++i) queue.push(i);
    queue.close();
  });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(queue.pop().value(), i);
  EXPECT_FALSE(queue.pop().has_value());
}

TEST(BoundedQueue, SaysWhetherThereIsRoom) {
  BoundedQueue<int> queue(2);
  queue.push(1);
  EXPECT_FALSE(queue.is_full());
  queue.push(2);
  EXPECT_TRUE(queue.is_full());
  queue.pop();
  EXPECT_FALSE(queue.is_full());
}

TEST(BoundedQueue, CloseReleasesAWaitingProducer) {
  BoundedQueue<int> queue(1);
  ASSERT_TRUE(queue.push(1));
  std::jthread producer([&queue] { EXPECT_FALSE(queue.push(2)); });
  queue.close();
  producer.join();
  EXPECT_EQ(queue.pop().value(), 1);
}

}  // namespace
}  // namespace ldso
