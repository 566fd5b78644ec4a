#pragma once

#include <Eigen/Core>
#include <functional>

#include "image/remap_kernels.h"
#include "ldso/calibration.h"
#include "ldso/image.h"

namespace ldso {

/// Where a rectified image of a camera shows what an output pixel is to show.
using Displacement = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

/// Resamples images of a camera with distortion to those of a pinhole camera, by a table made once.
/// An output of less than half the input's resolution is taken from a halved input (2 x 2 means, repeatedly), so that
/// fine texture does not alias; the outermost two pixels may then be off by up to a pixel, where the halved input ends.
/// Immutable after construction.
class Rectifier {
 public:
  /// Throws Error where the calibration or the request makes no sense; see fit_pinhole.
  Rectifier(const CameraCalibration& camera, const Rectification& rectification);

  /// The same with what moves pixels beside the lens, as a rolling shutter does, undone in one interpolation.
  Rectifier(const CameraCalibration& camera, const Rectification& rectification, const Displacement& warp);

  /// The camera of the rectified images.
  const PinholeIntrinsics& output_camera() const { return output_camera_; }

  /// Whether output and input are the same image: apply() would copy.
  bool is_identity() const { return is_identity_; }

  /// Masked images (masked_image.h); `input` contiguous with the size of the camera, `output` with that of
  /// output_camera(). Marked: pixels the input does not show, or interpolated from marked ones.
  void apply(ImageView<const float> input, ImageView<float> output) const;

 private:
  PinholeIntrinsics output_camera_;
  bool is_identity_ = false;
  int halvings_ = 0;
  RemapTable table_;
};

}  // namespace ldso
