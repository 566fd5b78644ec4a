#include "core/image_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace ldso::ros {
namespace {

NodeImage image(std::int64_t stamp) {
  NodeImage result;
  result.stamp_ns = stamp;
  return result;
}

TEST(ImageQueue, LetsTheOldestGoForNewOnes) {
  ImageQueue queue(2);
  EXPECT_EQ(queue.push(image(1)), 0U);
  EXPECT_EQ(queue.push(image(2)), 0U);
  EXPECT_EQ(queue.push(image(3)), 1U);
  EXPECT_EQ(queue.pop()->stamp_ns, 2);
  EXPECT_EQ(queue.pop()->stamp_ns, 3);
}

TEST(ImageQueue, WithoutCapacityKeepsAll) {
  ImageQueue queue(0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(queue.push(image(i)), 0U);
  queue.close(true);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(queue.pop()->stamp_ns, i);
  EXPECT_FALSE(queue.pop());
}

TEST(ImageQueue, ClosedTakesNoMoreAndWakesWhoWaits) {
  ImageQueue queue(0);
  std::thread waiting([&] { EXPECT_FALSE(queue.pop()); });
  queue.close(false);
  waiting.join();
  EXPECT_EQ(queue.push(image(1)), 1U);
  EXPECT_FALSE(queue.pop());
}

TEST(ImageQueue, ClosedForgetsWhatIsNotToBeKept) {
  ImageQueue queue(0);
  queue.push(image(1));
  queue.close(false);
  EXPECT_FALSE(queue.pop());
}

}  // namespace
}  // namespace ldso::ros
