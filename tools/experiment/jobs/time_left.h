#pragma once
// How long jobs take, learned from those that have ended.

#include <map>
#include <optional>
#include <string>

#include "experiment/jobs/job.h"

namespace ldso {

class TimeLeft {
 public:
  /// A job of this kind has taken so long [s].
  void learn(const ExperimentJob& job, double seconds);

  /// What such a job takes [s]: the mean of those of the same sequence and variant; if there is none of the same
  /// sequence, of the same dataset, of all. Nothing while none has ended.
  std::optional<double> expected(const ExperimentJob& job) const;

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
  };
  std::map<std::string, Mean> means_;
};

/// "45 s", "12 min", "3 h 20 min", "2 d 4 h".
std::string readable_duration(double seconds);

}  // namespace ldso
