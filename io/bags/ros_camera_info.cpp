#include <algorithm>

#include "io/calibration/calibration_doubts.h"
#include "io/calibration/foreign_camera.h"
#include "io/calibration/lens.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/ros_messages.h"

namespace ldso {
namespace {

/// Of pixels that were put together: `x` counts from the middle of the first.
double binned(double x, std::uint32_t binning) { return (x + 0.5) / binning - 0.5; }

CameraCalibration camera_of(const RosCameraInfo& info, bool is_rectified, const std::string& where) {
  CameraCalibration camera;
  const std::uint32_t bx = std::max(info.binning_x, 1U), by = std::max(info.binning_y, 1U);
  const std::uint32_t width = info.roi_width > 0 ? info.roi_width : info.width;
  const std::uint32_t height = info.roi_height > 0 ? info.roi_height : info.height;
  set_size(camera, width / bx, height / by, where);
  const double fx = is_rectified ? info.P[0] : info.K[0], fy = is_rectified ? info.P[5] : info.K[4];
  const double cx = is_rectified ? info.P[2] : info.K[2], cy = is_rectified ? info.P[6] : info.K[5];
  set_intrinsics(camera, fx / bx, fy / by, binned(cx - info.roi_x, bx), binned(cy - info.roi_y, by), where);
  if (is_rectified || info.distortion.empty()) {
    set_lens(camera, "none", {}, where);
  } else {
    set_lens(camera, info.model.empty() ? "plumb_bob" : info.model, info.distortion, where);
  }
  return camera;
}

}  // namespace

Calibration to_calibration(const RosCameraInfo& info, bool is_rectified, const std::string& where) {
  if (info.K[0] == 0)
    throw Error(where, "says that the camera is not calibrated", "calibrate it, or give a calibration");
  Calibration calibration;
  calibration.camera = camera_of(info, is_rectified, where);
  const bool is_pinhole = calibration.camera.model == CameraModelKind::kPinhole;
  calibration.rectification.mode = is_pinhole ? RectificationMode::kNone : RectificationMode::kCrop;
  calibration.description = where + (is_rectified ? " (P, of rectified images), " : ", ") +
                            describe(calibration.camera, calibration.rectification);
  doubt_intrinsics(calibration.camera, where, calibration.warnings);
  return calibration;
}

bool has_rectified_images(const std::string& topic) {
  return topic.substr(topic.rfind('/') + 1).starts_with("image_rect");
}

std::string camera_info_topic(const std::string& image_topic) {
  const std::size_t slash = image_topic.rfind('/');
  return (slash == std::string::npos ? "" : image_topic.substr(0, slash + 1)) + "camera_info";
}

}  // namespace ldso
