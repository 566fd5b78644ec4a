#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "core/slam_node.h"

namespace ldso::ros {

/// Between the thread on which ROS brings images and the one that processes them.
class ImageQueue {
 public:
  /// At most `capacity` wait, and the oldest ones leave for new ones; 0: all wait.
  explicit ImageQueue(std::size_t capacity) : capacity_(capacity) {}

  /// How many images left for it.
  std::size_t push(NodeImage image);
  /// Waits for one. Nothing once the queue is closed and empty.
  std::optional<NodeImage> pop();
  /// No image comes any more; those that wait stay if `keep`.
  void close(bool keep);

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<NodeImage> images_;
  bool is_closed_ = false;
};

}  // namespace ldso::ros
