#include "util/thread_pool.h"

#include <algorithm>
#include <utility>

#include "util/spin.h"

namespace ldso {

ThreadPool::ThreadPool(int threads) { grow(threads); }

void ThreadPool::grow(int threads) {
  while (this->threads() < threads) {
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
  {
    const std::lock_guard lock(mutex_);
    task_ = &task;
    chunks_ = chunks;
    error_ = nullptr;
    next_chunk_ = 0;
    ++loops_;
  }
  wake_.notify_all();
  run_available_chunks(task);
  spin_until([this] { return running_ == 0; });
  std::unique_lock lock(mutex_);
  task_ = nullptr;  // Who comes now comes too late.
  done_.wait(lock, [this] { return running_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ThreadPool::for_chunks(int count, int chunk_size, const std::function<void(int, int, int)>& task) {
  run(chunk_count(count, chunk_size), [&](int chunk) {
    const int begin = chunk * chunk_size;
    task(chunk, begin, std::min(count, begin + chunk_size));
  });
}

void ThreadPool::work(const std::stop_token& stop) {
  std::uint64_t seen = 0;
  while (!stop.stop_requested()) {
    spin_until([&] { return loops_ != seen || stop.stop_requested(); });
    std::unique_lock lock(mutex_);
    if (loops_ == seen && !wake_.wait(lock, stop, [&] { return loops_ != seen; })) return;
    seen = loops_;
    if (task_ == nullptr) continue;
    const auto& task = *task_;
    ++running_;
    lock.unlock();
    run_available_chunks(task);
    lock.lock();
    if (--running_ == 0) done_.notify_all();
  }
}

void ThreadPool::run_available_chunks(const std::function<void(int)>& task) {
  for (int chunk = next_chunk_++; chunk < chunks_; chunk = next_chunk_++) {
    try {
      task(chunk);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }
}

}  // namespace ldso
