#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace ldso {

/// A fixed set of workers for data-parallel loops. Work is cut into chunks that depend on the amount of
/// work only, never on the number of threads: reducing per-chunk results in chunk order gives the same
/// bits for any number of threads.
///
/// Loops follow each other within microseconds (one an iteration of a solver), less than it takes to wake a thread:
/// who has nothing to do looks out for the next loop for a short while before it sleeps.
class ThreadPool {
 public:
  /// `threads` counts the calling thread: 1 runs everything in place.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// From now on there are at least so many. Not while a loop runs.
  void grow(int threads);

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls `task(chunk)` for chunk = 0..chunks-1, in any order on any thread; returns when all are done.
  /// The first exception thrown by a task is rethrown. Not reentrant.
  void run(int chunks, const std::function<void(int)>& task);

  /// Cuts [0, count) into chunks of `chunk_size` and calls `task(chunk, begin, end)` for each.
  void for_chunks(int count, int chunk_size, const std::function<void(int, int, int)>& task);

  static int chunk_count(int count, int chunk_size) { return (count + chunk_size - 1) / chunk_size; }

 private:
  void work(const std::stop_token& stop);
  void run_available_chunks(const std::function<void(int)>& task);

  std::mutex mutex_;  ///< Of what follows, but for the atomic ones.
  std::condition_variable_any wake_;
  std::condition_variable done_;
  const std::function<void(int)>* task_ = nullptr;
  int chunks_ = 0;
  std::exception_ptr error_;
  std::atomic<std::uint64_t> loops_ = 0;  ///< That were begun.
  std::atomic<int> next_chunk_ = 0;
  std::atomic<int> running_ = 0;  ///< Workers that take part in the loop.
  std::vector<std::jthread> workers_;
};

}  // namespace ldso
