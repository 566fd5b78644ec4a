#include "util/thread_pool.h"

#include <algorithm>
#include <utility>

namespace ldso {

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) {
    workers_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

ThreadPool::~ThreadPool() {
  for (auto& worker : workers_) worker.request_stop();
  wake_.notify_all();
}

void ThreadPool::run(int chunks, const std::function<void(int)>& task) {
  if (workers_.empty() || chunks <= 1) {
    for (int chunk = 0; chunk < chunks; ++chunk) task(chunk);
    return;
  }
  std::unique_lock lock(mutex_);
  task_ = &task;
  next_chunk_ = 0;
  chunks_ = chunks;
  error_ = nullptr;
  wake_.notify_all();
  run_available_chunks(lock);
  done_.wait(lock, [this] { return running_ == 0; });
  task_ = nullptr;
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ThreadPool::for_chunks(int count, int chunk_size, const std::function<void(int, int, int)>& task) {
  run(chunk_count(count, chunk_size), [&](int chunk) {
    const int begin = chunk * chunk_size;
    task(chunk, begin, std::min(count, begin + chunk_size));
  });
}

void ThreadPool::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return task_ != nullptr && next_chunk_ < chunks_; })) {
    run_available_chunks(lock);
  }
}

void ThreadPool::run_available_chunks(std::unique_lock<std::mutex>& lock) {
  while (task_ != nullptr && next_chunk_ < chunks_) {
    const int chunk = next_chunk_++;
    const auto& task = *task_;
    ++running_;
    lock.unlock();
    std::exception_ptr error;
    try {
      task(chunk);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error && !error_) error_ = error;
    if (--running_ == 0) done_.notify_all();
  }
}

}  // namespace ldso
