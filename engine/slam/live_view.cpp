#include "slam/live_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/pinhole_projection.h"
#include "odometry/window/finished_keyframe.h"

namespace ldso {
namespace {

Image<float> intensities(const PreparedFrame& frame) {
  const Image<Texel>& texels = frame.pyramid.levels.front();
  Image<float> image(texels.width(), texels.height());
  std::transform(texels.data(), texels.data() + texels.size(), image.data(),
                 [](const Texel& texel) { return texel.intensity; });
  return image;
}

/// Projects points of one keyframe into the frame.
class Projection {
 public:
  Projection(const PinholeIntrinsics& camera, const SE3d& T_frame_host)
      : camera_(camera), R_(T_frame_host.rotation_matrix()), t_(T_frame_host.translation()) {}

  /// Nothing is added if the point is not in view.
  void add(ViewPixel pixel, std::vector<ViewPixel>& pixels) const {
    const Eigen::Vector3d ray = viewing_ray(camera_, {pixel.u, pixel.v});
    const Eigen::Vector3d p = R_ * ray + pixel.idepth * t_;  // Divided by the depth in the host.
    if (!(p.z() > 0)) return;
    const Eigen::Vector2d seen = project(camera_, p);
    const Eigen::Array2d last(camera_.width - 1, camera_.height - 1);
    if (!((seen.array() >= 0).all() && (seen.array() <= last).all())) return;
    pixel.u = static_cast<float>(seen.x());
    pixel.v = static_cast<float>(seen.y());
    pixel.idepth = static_cast<float>(pixel.idepth / p.z());
    pixels.push_back(pixel);
  }

 private:
  PinholeIntrinsics camera_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d t_;
};

void add_pixels(const Keyframe& keyframe, const Projection& projection, std::vector<ViewPixel>& pixels) {
  for (const ImmaturePoint& point : keyframe.immature) {
    if (!std::isfinite(point.idepth_max)) continue;  // Never found: it may be anywhere on its line.
    const float idepth = std::max(0.5f * (point.idepth_min + point.idepth_max), 0.0f);
    projection.add({point.u, point.v, idepth, point.is_corner, true}, pixels);
  }
  for (const ActivePoint& point : keyframe.points) {
    projection.add({point.u, point.v, point.idepth, point.is_corner, false}, pixels);
  }
}

}  // namespace

std::optional<SE3d> pose_in_world(const Window& window, const FrameRecord& record) {
  if (record.state != TrackingState::kTracked) return std::nullopt;
  for (const auto& keyframe : window.keyframes) {
    if (keyframe->id() == record.keyframe_id) return keyframe->state.T_c_w().inverse() * record.T_keyframe_frame;
  }
  return std::nullopt;
}

int active_points(const Window& window) {
  std::size_t points = 0;
  for (const auto& keyframe : window.keyframes) points += keyframe->points.size();
  return static_cast<int>(points);
}

LiveView make_live_view(const Window& window, const FrameRecord& record, std::shared_ptr<const PreparedFrame> frame) {
  LiveView view;
  view.frame_id = record.frame_id;
  view.camera = window.intrinsics();
  for (const auto& keyframe : window.keyframes) {
    WindowKeyframe& shown = view.window.emplace_back();
    shown.frame_id = keyframe->id();
    shown.T_world_camera = keyframe->state.T_c_w().inverse();
    shown.readout = window.readout(*keyframe);
    shown.points.reserve(keyframe->points.size());
    for (const ActivePoint& point : keyframe->points) {
      shown.points.push_back(make_map_point(point, window.residual_variance()));
    }
  }
  view.T_world_camera = pose_in_world(window, record);
  if (view.T_world_camera) {
    const SE3d T_camera_world = view.T_world_camera->inverse();
    for (const auto& keyframe : window.keyframes) {
      add_pixels(*keyframe, Projection(view.camera, T_camera_world * keyframe->state.T_c_w().inverse()), view.pixels);
    }
  }
  view.image = [frame = std::move(frame)] { return intensities(*frame); };
  return view;
}

}  // namespace ldso
