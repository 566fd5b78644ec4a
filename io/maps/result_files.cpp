#include "ldso/io/result_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "util/format_text.h"

namespace ldso {
namespace {

std::uint8_t grey_level(float intensity) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(intensity, 0.0f, 255.0f)));
}

CameraCalibration as_calibration(const PinholeIntrinsics& camera) {
  return {CameraModelKind::kPinhole, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, {}};
}

}  // namespace

Trajectory to_trajectory(const std::vector<TimedPose>& poses) {
  Trajectory trajectory;
  trajectory.reserve(poses.size());
  for (const TimedPose& pose : poses) trajectory.push_back({pose.timestamp, pose.T_world_camera});
  return trajectory;
}

std::vector<PlyPoint> to_cloud(const std::vector<WorldPoint>& points) {
  std::vector<PlyPoint> cloud;
  cloud.reserve(points.size());
  for (const WorldPoint& point : points) {
    const Eigen::Vector3f p = point.position.cast<float>();
    cloud.push_back({p.x(), p.y(), p.z(), grey_level(point.intensity), point.idepth_stddev});
  }
  return cloud;
}

ColmapModel to_colmap_model(const PinholeIntrinsics& camera, const std::vector<TimedPose>& keyframes,
                            const std::vector<WorldPoint>& points) {
  ColmapModel model;
  model.camera = as_calibration(camera);
  std::map<std::int64_t, std::size_t> image_of;
  for (const TimedPose& pose : keyframes) {
    image_of[pose.frame_id] = model.images.size();
    model.images.push_back({format_text("%06lld.png", static_cast<long long>(pose.frame_id)), pose.T_world_camera, {}});
  }
  for (const WorldPoint& point : points) {
    const auto host = image_of.find(point.keyframe_id);
    if (host == image_of.end()) continue;
    model.images[host->second].observations.push_back({point.pixel.cast<double>(), model.points.size()});
    model.points.push_back({point.position, grey_level(point.intensity)});
  }
  return model;
}

}  // namespace ldso
