#pragma once
// Points to `ldso doctor` when a run goes badly.

#include <cstdint>
#include <string>

#include "ldso/log.h"
#include "ldso/records.h"

namespace ldso {

class DoctorHint {
 public:
  /// `sequence`: as it has to be given to the doctor; empty: it cannot look at it (a camera).
  DoctorHint(std::string sequence, LogSink log);

  /// To be called after each frame. Says it once when the start takes long, and once when the camera is lost, with the
  /// reason that the frame has.
  void after_frame(const FrameRecord& frame);

 private:
  void say(const std::string& what, const FrameRecord& frame);

  std::string sequence_;
  LogSink log_;
  double start_ = 0;      ///< Time of the first frame [s].
  bool started_ = false;  ///< A map was there.
  bool said_late_ = false, said_lost_ = false;
};

}  // namespace ldso
