#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ldso/image.h"

namespace ldso {

enum class CameraModelKind { kPinhole, kFov, kRadTan, kKannalaBrandt, kDoubleSphere, kEucm };

/// Intrinsics of the camera as it took the images, in absolute pixels (pixel centres at integers).
/// `distortion`: FOV: omega; RadTan: k1 k2 p1 p2; Kannala-Brandt: k1 k2 k3 k4; double sphere: xi alpha; EUCM (enhanced
/// unified): alpha beta; pinhole: unused.
struct CameraCalibration {
  CameraModelKind model = CameraModelKind::kPinhole;
  int width = 0;
  int height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<double, 4> distortion{};
  double readout_ms =
      0;  ///< Rolling shutter: time from the first row to the last; negative: upwards. 0: global shutter.
  /// RadTan alone: k3, and k4 k5 k6 of the denominator, as OpenCV has them. They are kept as given where a run corrects
  /// the others.
  std::array<double, 4> more_distortion{};
};

/// How the images are resampled to a pinhole image.
enum class RectificationMode {
  kNone,      ///< Images are used as they are; only valid for pinhole cameras.
  kCrop,      ///< Largest pinhole image all of whose pixels are inside the input.
  kFull,      ///< Smallest pinhole image that shows every input pixel; the rest is invalid.
  kExplicit,  ///< Given output intrinsics.
};

/// A pinhole camera without distortion, in absolute pixels (pixel centres at integers).
struct PinholeIntrinsics {
  int width = 0;
  int height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

struct Rectification {
  RectificationMode mode = RectificationMode::kNone;
  int width = 0;                          ///< Output size [px]; 0: as the input.
  int height = 0;                         ///< Output size [px]; 0: as the input.
  PinholeIntrinsics explicit_intrinsics;  ///< Read for kExplicit only.
};

/// I = G(t * V(x) * B(x)): inverse response G^-1 and vignette V (TUM-mono benchmark, arXiv 1607.02555).
struct PhotometricCalibration {
  /// Irradiance (scaled to 0..255) of each 8-bit grey value; strictly monotone.
  std::optional<std::array<float, 256>> inverse_response;
  /// Attenuation in (0, 1], 1 at its maximum; size of the input images. Empty: none.
  Image<float> vignette;
};

/// Where a calibration is from. All but the first are of a camera that might have taken images of this size: what is
/// run with one of them as it is will be wrong; a run over a sequence looks for the camera first.
enum class CameraSource {
  kCalibrated,
  kMetadata,  ///< The focal length as the images' metadata have it.
  kNone,      ///< Nobody said anything.
};

struct Calibration {
  CameraCalibration camera;
  Rectification rectification;
  PhotometricCalibration photometric;
  /// How it was read ("relative" or "absolute" intrinsics, which file), for messages.
  std::string description;
  /// What is doubtful about it, though a camera may be like that.
  std::vector<std::string> warnings;
  CameraSource source = CameraSource::kCalibrated;

  bool is_guess() const { return source != CameraSource::kCalibrated; }
};

}  // namespace ldso
