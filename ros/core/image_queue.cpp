#include "core/image_queue.h"

#include <utility>

namespace ldso::ros {

std::size_t ImageQueue::push(NodeImage image) {
  const std::lock_guard lock(mutex_);
  if (is_closed_) return 1;
  images_.push_back(std::move(image));
  std::size_t left = 0;
  for (; capacity_ > 0 && images_.size() > capacity_; ++left) images_.pop_front();
  changed_.notify_one();
  return left;
}

std::optional<NodeImage> ImageQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_closed_ || !images_.empty(); });
  if (images_.empty()) return std::nullopt;
  NodeImage image = std::move(images_.front());
  images_.pop_front();
  return image;
}

void ImageQueue::close(bool keep) {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  if (!keep) images_.clear();
  changed_.notify_all();
}

}  // namespace ldso::ros
