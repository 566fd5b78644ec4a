#pragma once
// The first seconds of a sequence, run as `ldso run` does: what it says of motion, calibration and shutter needs no
// other judge.

#include <functional>
#include <string>
#include <vector>

#include "doctor/finding.h"
#include "ldso/io/dataset.h"
#include "ldso/sequence_run.h"

namespace ldso {

struct TrialRun {
  SequenceRun run;
  int frames = 0;                   ///< That were played.
  std::vector<std::string> losses;  ///< What was said when the camera was lost.
};

/// Without loop closing. `frames`: at most so many from the beginning.
TrialRun try_sequence(const Dataset& dataset, int frames, const std::function<void(int, int)>& progress = {});

/// Starts that fail or come late, losses, a calibration that the images contradict, a rolling shutter.
Findings trial_findings(const TrialRun& trial, const Dataset& dataset);

}  // namespace ldso
