#pragma once
// The frames of a finished run as pictures: rectified, in colour where there is one, and as if all rows had been read
// at once. A rolling shutter is undone by the motion between the poses and the depths of the map's points.

#include <optional>
#include <vector>

#include "image/rectifier.h"
#include "imagery/depth_field.h"
#include "imagery/placed_map.h"
#include "imagery/posed_frames.h"
#include "ldso/calibration.h"
#include "ldso/io/dataset.h"

namespace ldso {

/// By how much a rolling shutter displaces the points of a frame [px].
struct ShutterShift {
  double median = 0, largest = 0;
};

class FrameImages {
 public:
  /// `calibration`: what the run ended with; `camera`: of its rectified images, as estimated. `frames`: all that have a
  /// pose. Keeps references to the sequence and to the map. Throws Error if the calibration makes no sense.
  FrameImages(const Dataset& sequence, const Calibration& calibration, const PinholeIntrinsics& camera,
              const PlacedMap& placed, std::vector<FramePose> frames);

  bool has_rolling_shutter() const { return readout_s_ != 0; }

  /// Of the motion during the readout of a frame, in its rectified image; zero if the frame has no pose.
  ReadoutMotion motion(std::int64_t frame_id) const;

  /// How far that motion displaces the points that a frame shows.
  ShutterShift shift(std::int64_t frame_id) const;

  /// The rectified image, black where the camera sees nothing. `corrected`: as with a global shutter. Throws Error if
  /// the frame cannot be read.
  Image<Rgb> rectified(std::int64_t frame_id, bool corrected) const;

  const std::vector<FramePose>& frames() const { return frames_; }
  /// As estimated by the run, and as the images are made.
  const PinholeIntrinsics& camera() const { return camera_; }
  const PinholeIntrinsics& image_camera() const { return rectifier_.output_camera(); }

 private:
  std::optional<std::size_t> find(std::int64_t frame_id) const;
  template <class Action>
  void for_each_point(const FramePose& frame, const Action& action) const;
  DepthField depths(const FramePose& frame) const;

  const Dataset& sequence_;
  Calibration calibration_;
  PinholeIntrinsics camera_;
  PlacedMap placed_;
  std::vector<FramePose> frames_;
  std::vector<FrameSpan> spans_;
  Rectifier rectifier_;
  double readout_s_;
};

/// Each channel through the rectifier; what the camera does not see is black.
Image<Rgb> rectified(const Image<Rgb>& image, const Rectifier& rectifier);

/// By the BT.601 weights, as images are read for tracking.
Image<float> to_grey(const Image<Rgb>& image);

/// Whether any pixel is other than grey.
bool has_color(const Image<Rgb>& image);

}  // namespace ldso
