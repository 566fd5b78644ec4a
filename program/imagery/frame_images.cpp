#include "imagery/frame_images.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "geometry/camera_model.h"
#include "geometry/pinhole_projection.h"
#include "geometry/rolling_shutter.h"
#include "image/masked_image.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Time from the first row of the rectified image to its last [s].
double readout_of(const CameraCalibration& lens, const PinholeIntrinsics& rectified) {
  if (lens.readout_ms == 0) return 0;
  return 1e-3 * lens.readout_ms * covered_rows(*make_camera_model(lens), rectified);
}

Rectification to_this(const PinholeIntrinsics& camera) {
  Rectification rectification;
  rectification.mode = RectificationMode::kExplicit;
  rectification.width = camera.width;
  rectification.height = camera.height;
  rectification.explicit_intrinsics = camera;
  return rectification;
}

}  // namespace

FrameImages::FrameImages(const Dataset& sequence, const Calibration& calibration, const PinholeIntrinsics& camera,
                         const PlacedMap& placed, std::vector<FramePose> frames)
    : sequence_(sequence),
      calibration_(calibration),
      camera_(camera),
      placed_(placed),
      frames_(std::move(frames)),
      spans_(window_spans(placed.map)),
      rectifier_(calibration.camera, calibration.rectification),
      readout_s_(readout_of(calibration.camera, rectifier_.output_camera())) {}

std::optional<std::size_t> FrameImages::find(std::int64_t frame_id) const {
  const auto found = std::lower_bound(frames_.begin(), frames_.end(), frame_id,
                                      [](const FramePose& frame, std::int64_t id) { return frame.id < id; });
  if (found == frames_.end() || found->id != frame_id) return std::nullopt;
  return static_cast<std::size_t>(found - frames_.begin());
}

ReadoutMotion FrameImages::motion(std::int64_t frame_id) const {
  const std::optional<std::size_t> index = find(frame_id);
  return index ? readout_motion(frames_, *index, readout_s_) : ReadoutMotion(ReadoutMotion::Zero());
}

/// With the pixel and inverse depth of each point of the map that the frame may see.
template <class Action>
void FrameImages::for_each_point(const FramePose& frame, const Action& action) const {
  const Sim3d S_camera_world(frame.T_world_camera.inverse());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    if (!spans_[i].contains(frame.id)) continue;
    const Sim3d S_camera_host = S_camera_world * placed_.poses[i];
    for (const Eigen::Vector3f& point : placed_.map.keyframes[i].points) {
      const Eigen::Vector3d p = S_camera_host * point.cast<double>();
      if (p.z() > 0) action(project(camera_, p), 1 / p.z());
    }
  }
}

DepthField FrameImages::depths(const FramePose& frame) const {
  DepthField field(camera_.width, camera_.height);
  for_each_point(frame, [&](const Eigen::Vector2d& pixel, double idepth) { field.add(pixel, idepth); });
  field.spread();
  return field;
}

ShutterShift FrameImages::shift(std::int64_t frame_id) const {
  const std::optional<std::size_t> index = find(frame_id);
  const ReadoutMotion moved = motion(frame_id);
  if (!index || moved.isZero(0)) return {};
  std::vector<double> shifts;
  for_each_point(frames_[*index], [&](const Eigen::Vector2d& pixel, double idepth) {
    if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() >= camera_.width || pixel.y() >= camera_.height) return;
    shifts.push_back((with_readout(camera_, moved, pixel, idepth) - pixel).norm());
  });
  if (shifts.empty()) return {};
  const double largest = *std::max_element(shifts.begin(), shifts.end());
  return {median_of(std::move(shifts)), largest};
}

Image<Rgb> FrameImages::rectified(std::int64_t frame_id, bool corrected) const {
  const Image<Rgb> image = sequence_.read_color(static_cast<int>(frame_id));
  const std::optional<std::size_t> index = find(frame_id);
  const ReadoutMotion moved = motion(frame_id);
  if (!corrected || !index || moved.isZero(0)) return ldso::rectified(image, rectifier_);
  const DepthField field = depths(frames_[*index]);
  const Displacement warp = [&](const Eigen::Vector2d& pixel) {
    return with_readout(camera_, moved, pixel, field.at(pixel));
  };
  return ldso::rectified(image, Rectifier(calibration_.camera, to_this(rectifier_.output_camera()), warp));
}

Image<Rgb> rectified(const Image<Rgb>& image, const Rectifier& rectifier) {
  if (rectifier.is_identity()) return image;
  const PinholeIntrinsics& camera = rectifier.output_camera();
  Image<Rgb> result(camera.width, camera.height);
  Image<float> channel(image.width(), image.height()), bent(camera.width, camera.height);
  for (std::size_t c = 0; c < 3; ++c) {
    std::transform(image.data(), image.data() + image.size(), channel.data(), [=](const Rgb& v) { return v[c]; });
    rectifier.apply(channel.view(), bent.view());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const float level = is_marked(bent.data()[i]) ? 0.0F : bent.data()[i];
      result.data()[i][c] = static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0F, 255.0F)));
    }
  }
  return result;
}

Image<float> to_grey(const Image<Rgb>& image) {
  Image<float> grey(image.width(), image.height());
  std::transform(image.data(), image.data() + image.size(), grey.data(), [](const Rgb& v) {
    return 0.299F * static_cast<float>(v[0]) + 0.587F * static_cast<float>(v[1]) + 0.114F * static_cast<float>(v[2]);
  });
  return grey;
}

bool has_color(const Image<Rgb>& image) {
  return std::any_of(image.data(), image.data() + image.size(),
                     [](const Rgb& v) { return v[0] != v[1] || v[1] != v[2]; });
}

}  // namespace ldso
