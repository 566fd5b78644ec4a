#pragma once

// Frames that come at times of their own, whether anybody is ready for them or not: a camera, or a recorded sequence
// played as if it were one.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/frame_source.h"

namespace ldso {

/// To be used by one thread at a time.
class FrameStream {
 public:
  /// A frame that has come and not been looked at yet.
  struct Arrival {
    std::int64_t index = 0;  ///< Counts the frames from 0, those that were missed as well.
    double timestamp = 0;    ///< [s]
  };

  virtual ~FrameStream() = default;
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  virtual const Calibration& calibration() const = 0;
  /// Frames in all; 0 if nobody knows.
  virtual int size() const = 0;
  /// Waits for the next frame. Frames that came and went before this call are missed: their indices are left out.
  /// Nothing after the last one, or soon after `is_over` says so. Throws Error if the source fails.
  virtual std::optional<Arrival> wait(const std::function<bool()>& is_over) = 0;
  /// The frame that wait() announced last. Throws Error if it cannot be decoded; the next one can still be waited for.
  virtual RawFrame read() = 0;

 protected:
  FrameStream() = default;
};

/// Plays a sequence at its own pace, by its timestamps, from the first call of wait() on. The source must outlive it.
std::unique_ptr<FrameStream> make_paced_stream(const FrameSource& source);

}  // namespace ldso
