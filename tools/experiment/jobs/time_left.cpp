#include "experiment/jobs/time_left.h"

#include <array>
#include <cmath>

namespace ldso {
namespace {

/// From the most particular kind to all; names of sequences and datasets hold no '/'.
std::array<std::string, 4> kinds_of(const ExperimentJob& job) {
  return {"s/" + job.sequence + "/" + job.variant, "s/" + job.sequence, "d/" + job.dataset, ""};
}

}  // namespace

void TimeLeft::learn(const ExperimentJob& job, double seconds) {
  for (const std::string& kind : kinds_of(job)) {
    means_[kind].sum += seconds;
    ++means_[kind].count;
  }
}

std::optional<double> TimeLeft::expected(const ExperimentJob& job) const {
  for (const std::string& kind : kinds_of(job)) {
    const auto mean = means_.find(kind);
    if (mean != means_.end()) return mean->second.sum / mean->second.count;
  }
  return std::nullopt;
}

std::string readable_duration(double seconds) {
  const auto text = [](long number, const char* unit) { return std::to_string(number) + " " + unit; };
  const long s = std::lround(seconds), minutes = std::lround(seconds / 60), hours = std::lround(seconds / 3600);
  if (s < 100) return text(s, "s");
  if (minutes < 100) return text(minutes, "min");
  if (hours < 48) return text(minutes / 60, "h ") + text(minutes % 60, "min");
  return text(hours / 24, "d ") + text(hours % 24, "h");
}

}  // namespace ldso
