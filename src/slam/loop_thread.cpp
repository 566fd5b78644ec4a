#include "slam/loop_thread.h"

#include <exception>
#include <utility>

#include "place/default_vocabulary.h"
#include "util/log.h"

namespace ldso {
namespace {

/// Keyframes that may wait with their images.
constexpr std::size_t kMostWaiting = 16;

}  // namespace

LoopThread::LoopThread(LogSink log) : log_(std::move(log)), queue_(kMostWaiting), thread_([this] { work(); }) {}

LoopThread::~LoopThread() { queue_.close(); }

void LoopThread::add(FinishedKeyframe keyframe, const PinholeIntrinsics& camera) {
  queue_.push({std::move(keyframe), camera});
}

void LoopThread::work() {
  try {
    closer_ = std::make_unique<LoopCloser>(std::make_shared<const Vocabulary>(default_vocabulary()));
    while (std::optional<Item> item = queue_.pop()) {
      const FinishedKeyframe& keyframe = item->keyframe;
      closer_->add(keyframe.update, keyframe.corners, keyframe.frame->pyramid.levels.front(), item->camera);
    }
    closer_->finish();
  } catch (const std::exception& error) {
    failed_ = true;
    log_to(log_, LogLevel::kWarning, std::string("loop closing ends: ") + error.what());
    queue_.close();
  }
}

const LoopCloser* LoopThread::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  return failed_ ? nullptr : closer_.get();
}

}  // namespace ldso
