#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace ldso {

/// Calls, sum and worst of the time spent in each named stage [ms].
class StageTimes {
 public:
  struct Entry {
    std::int64_t calls = 0;
    double total_ms = 0;
    double worst_ms = 0;
  };

  void add(const std::string& stage, double ms) {
    Entry& entry = entries_[stage];
    ++entry.calls;
    entry.total_ms += ms;
    if (ms > entry.worst_ms) entry.worst_ms = ms;
  }
  const std::map<std::string, Entry>& entries() const { return entries_; }

 private:
  std::map<std::string, Entry> entries_;
};

/// Adds the time between its construction and its destruction to a stage.
class StageTimer {
 public:
  StageTimer(StageTimes& times, std::string stage)
      : times_(times), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start_;
    times_.add(stage_, elapsed.count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace ldso
