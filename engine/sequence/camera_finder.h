#pragma once

// The camera of a sequence that nobody calibrated, or whose calibration is too wrong to be mended: several that might
// have taken it are tried on the first frames, and the one with which the images are explained best is where
// self-calibration begins.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/frame_source.h"
#include "ldso/log.h"
#include "ldso/settings.h"

namespace ldso {

/// Pinholes with the fields of view of usual cameras, the wider ones also with the distortion that such lenses have,
/// and a wide-angle lens; if `guess` comes from the images' metadata, some around it.
std::vector<Calibration> possible_cameras(const Calibration& guess);

struct CameraFinding {
  Calibration calibration;
  std::string doubt;  ///< Why it may be another one; empty if nothing speaks for that.
};

/// The best of them, refined by what the windows of the trials say; the source's guess if none of them gave a map, or
/// once `stop` is true. `source`: with a calibration that is a guess. Frames that cannot be read are skipped.
CameraFinding find_camera(const FrameSource& source, const Settings& settings, const LogSink& log,
                          const std::atomic<bool>* stop);

/// One that explains the first frames far better than `given` does, without a doubt; nothing if there is none.
struct OtherCamera {
  Calibration calibration;
  std::string proof;  ///< What speaks for it.
};
std::optional<OtherCamera> find_other_camera(const FrameSource& source, const Calibration& given,
                                             const Settings& settings, const LogSink& log,
                                             const std::atomic<bool>* stop);

}  // namespace ldso
