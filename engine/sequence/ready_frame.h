#pragma once

// A frame as a reading thread hands it to the pipeline: decoded and preprocessed, or why it cannot be.

#include <functional>
#include <memory>

#include "image/frame_preprocessor.h"
#include "slam/pipeline.h"

namespace ldso {

struct ReadyFrame {
  std::shared_ptr<const RawFrame> raw;
  std::shared_ptr<const PreparedFrame> frame;
  double decode_ms = 0;
  double preprocess_ms = 0;
};

/// `read` decodes it.
ReadyFrame make_ready(const std::function<RawFrame()>& read, const FramePreprocessor& preprocessor);

/// Tracks it; the times of its making go with it.
const FrameRecord& feed(Pipeline& pipeline, const ReadyFrame& ready);

}  // namespace ldso
