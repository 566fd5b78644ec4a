#pragma once

#include <string>

#include "image/frame.h"
#include "image/photometric_calibration.h"
#include "image/rectifier.h"
#include "ldso/calibration.h"
#include "ldso/settings.h"

namespace ldso {

/// From a frame as the camera took it to one ready for tracking: response and vignette undone, rectified, with its
/// pyramid. Immutable after construction: frames may be processed on several threads at once.
class FramePreprocessor {
 public:
  /// Throws Error if the calibration or the wanted rectification makes no sense.
  FramePreprocessor(const Calibration& calibration, const PhotometrySettings& settings);

  /// A texel is invalid if it, a pixel it was interpolated from or a neighbour its gradient was taken of is
  /// overexposed, behind a black vignette or outside of the input image. An exposure that is not finite and
  /// positive counts as unknown. Throws Error naming the frame if its size is not that of the calibration.
  PreparedFrame process(const RawFrame& raw) const;

  /// Throws Error that says it is `frame` unless the size is that of the calibration.
  void check_size(const std::string& frame, int width, int height) const;

  /// The camera of the prepared frames.
  const PinholeIntrinsics& output_camera() const { return rectifier_.output_camera(); }

  /// Whether the response is known and undone, so that intensities are proportional to irradiance.
  bool photometrically_calibrated() const { return photometric_.has_response(); }

 private:
  int width_;
  int height_;
  bool use_exposure_;
  PhotometricCorrection photometric_;
  Rectifier rectifier_;
};

}  // namespace ldso
