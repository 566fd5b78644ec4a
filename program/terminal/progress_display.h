#pragma once
// How far a run is.

#include <string>

#include "ldso/log.h"
#include "ldso/sequence_run.h"
#include "terminal/progress_bar.h"

namespace ldso {

class ProgressDisplay {
 public:
  /// `quiet`: warnings only.
  explicit ProgressDisplay(bool quiet) : bar_(quiet) {}

  void update(const RunProgress& progress);

  /// Prints a message without damage to the bar. From any thread.
  void message(LogLevel level, const std::string& text) { bar_.message(level, text); }

 private:
  ProgressBar bar_;
};

}  // namespace ldso
