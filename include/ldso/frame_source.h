#pragma once

#include "ldso/calibration.h"
#include "ldso/raw_frame.h"

namespace ldso {

/// Frames of one camera that can be read as often as one likes: files, or what a program keeps.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  virtual int size() const = 0;
  /// Frame `index` in [0, size()), whose id is `index`. May be called from any thread, but from one at a time.
  /// Throws Error if the frame is unreadable; other frames can still be read then.
  virtual RawFrame read(int index) const = 0;
  virtual double timestamp(int index) const = 0;  ///< [s]
  virtual const Calibration& calibration() const = 0;

 protected:
  FrameSource() = default;
};

}  // namespace ldso
