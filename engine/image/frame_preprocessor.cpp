#include "image/frame_preprocessor.h"

#include <cmath>
#include <string>
#include <utility>

#include "image/masked_image.h"
#include "image/pyramid.h"
#include "ldso/error.h"

namespace ldso {
namespace {

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

/// What is masked, by a grey level below zero, carries no information, and no trace of what it shows stays.
void mark_masked(ImageView<const float> grey, ImageView<float> image) {
  for (int y = 0; y < image.height; ++y) {
    const float* row = grey.row(y);
    float* marked = image.row(y);
    for (int x = 0; x < image.width; ++x) marked[x] = row[x] < 0 ? mark_invalid(0) : marked[x];
  }
}

}  // namespace

FramePreprocessor::FramePreprocessor(const Calibration& calibration, const PhotometrySettings& settings)
    : width_(calibration.camera.width),
      height_(calibration.camera.height),
      use_exposure_(settings.use_exposure),
      photometric_(calibration.photometric, settings, width_, height_),
      rectifier_(calibration.camera, calibration.rectification) {}

PreparedFrame FramePreprocessor::process(const RawFrame& raw) const {
  const std::string name = raw.name.empty() ? "" : " (" + raw.name + ")";
  check_size("frame " + std::to_string(raw.id) + name, raw.grey.width(), raw.grey.height());
  MaskedImage image(width_, height_);
  photometric_.apply(raw.grey.view(), image.view());
  mark_masked(raw.grey.view(), image.view());
  if (!rectifier_.is_identity()) {
    MaskedImage rectified(output_camera().width, output_camera().height);
    rectifier_.apply(image.view(), rectified.view());
    image = std::move(rectified);
  }

  PreparedFrame frame;
  frame.id = raw.id;
  frame.timestamp = raw.timestamp;
  if (use_exposure_ && raw.exposure_ms && std::isfinite(*raw.exposure_ms) && *raw.exposure_ms > 0) {
    frame.exposure_ms = *raw.exposure_ms;
    frame.exposure_known = true;
  }
  frame.pyramid = build_pyramid(image.view());
  return frame;
}

void FramePreprocessor::check_size(const std::string& frame, int width, int height) const {
  if (width == width_ && height == height_) return;
  throw Error(
      frame,
      "the image has " + size_text(width, height) + " pixels but the calibration is for " + size_text(width_, height_),
      "calibrate for this image size, or correct the input size in the calibration file");
}

}  // namespace ldso
