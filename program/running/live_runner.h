#pragma once

// Frames through the pipeline as they come. A frame that comes while several wait is dropped: late poses are of no use
// to anybody, and what waits for ever is lost in the end as well.

#include "camera/frame_stream.h"
#include "ldso/sequence_run.h"

namespace ldso {

/// As run_sequence(), but that nothing can begin anew: where the first frames contradict the calibration, the run goes
/// on with it and says so, and `result.better_calibration` is for the next one. Frame ids are those of the stream;
/// frames that were dropped have no record. Depends on time, and so never gives the same twice.
SequenceRun run_live(FrameStream& stream, const Settings& settings, const LogSink& log = {},
                     const RunOptions& options = {});

}  // namespace ldso
