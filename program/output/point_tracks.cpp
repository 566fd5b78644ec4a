#include "output/point_tracks.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <thread>

#include "geometry/pinhole_projection.h"
#include "geometry/rolling_shutter.h"
#include "imagery/frame_images.h"
#include "imagery/point_colors.h"

namespace ldso {
namespace {

/// A patch that is seen larger or smaller by more than this is another one.
constexpr double kMostMagnification = 1.8;

constexpr int kPointsPerChunk = 256;

Calibration pinhole_calibration(const PinholeIntrinsics& camera) {
  Calibration calibration;
  calibration.camera = {
      CameraModelKind::kPinhole, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, {}};
  return calibration;
}

bool is_inside(const Eigen::Vector2d& pixel, const PinholeIntrinsics& camera) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width - 1 && pixel.y() <= camera.height - 1;
}

/// How offsets in the keyframe's image are seen in the other one, for a surface that faces the keyframe at `depth`.
Eigen::Matrix2d warp_at(const PinholeIntrinsics& camera, const Sim3d& S_camera_host, const Eigen::Vector2d& pixel,
                        double depth) {
  const auto seen = [&](const Eigen::Vector2d& p) {
    return project(camera, S_camera_host * (depth * viewing_ray(camera, p)).eval());
  };
  Eigen::Matrix2d warp;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d::Unit(k);
    warp.col(k) = seen(pixel + half) - seen(pixel - half);
  }
  return warp;
}

bool is_comparable(const Eigen::Matrix2d& warp) {
  const double area = warp.determinant(), limit = kMostMagnification * kMostMagnification;
  return area < limit && area > 1 / limit;
}

}  // namespace

/// A point that the image should show.
struct PointTracks::Candidate {
  std::size_t point = 0;
  Sim3d S_camera_host;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();
  bool is_host = false;  ///< The image is that of the point's keyframe, where it is by definition.
};

PointTracks::PointTracks(const PlacedMap& placed, const PinholeIntrinsics& camera)
    : placed_(placed),
      camera_(camera),
      preprocessor_(pinhole_calibration(camera), PhotometrySettings{}),
      spans_(window_spans(placed.map)),
      pool_(static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))) {
  for (std::size_t i = 0; i < placed.poses.size(); ++i) {
    first_point_.push_back(points_.size());
    const protocol::Keyframe& keyframe = placed.map.keyframes[i];
    for (std::size_t k = 0; k < keyframe.points.size(); ++k) {
      if (!(keyframe.depth_stddev[k] <= placed.most_deviation)) continue;
      Point point;
      point.keyframe = i;
      point.in_host = keyframe.points[k].cast<double>();
      positions_.push_back(placed.poses[i] * point.in_host);
      intensities_.push_back(keyframe.intensity[k]);
      points_.push_back(point);
    }
  }
  first_point_.push_back(points_.size());
  colors_.resize(points_.size());
}

PreparedFrame PointTracks::prepare(const TrackedImage& image) const {
  RawFrame raw;
  raw.id = image.id;
  raw.name = "frame " + std::to_string(image.id);
  raw.grey = to_grey(image.image);
  return preprocessor_.process(raw);
}

void PointTracks::add_keyframe(std::size_t index, const TrackedImage& image) {
  const PreparedFrame prepared = prepare(image);
  const Image<Texel>& texels = prepared.pyramid.levels.front();
  for (std::size_t i = first_point_[index]; i < first_point_[index + 1]; ++i) {
    Point& point = points_[i];
    const double idepth = 1 / point.in_host.z();
    const Eigen::Vector2d still = project(camera_, point.in_host);
    const Eigen::Vector2d seen = with_readout(camera_, image.motion, still, idepth);
    if (!seen.allFinite() || !is_inside(seen, camera_)) continue;
    const Eigen::Vector2d whole = seen.array().round();
    point.centre = still + (whole - seen);
    point.patch = cut_patch(texels, static_cast<float>(whole.x()), static_cast<float>(whole.y()));
    colors_[i] = colors_at(image.image, {seen}).front();
  }
}

std::vector<PointTracks::Candidate> PointTracks::candidates(const TrackedImage& image) const {
  std::vector<Candidate> found;
  const Sim3d S_camera_world(image.T_world_camera.inverse());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    if (!spans_[i].contains(image.id)) continue;
    Candidate candidate;
    candidate.S_camera_host = S_camera_world * placed_.poses[i];
    candidate.is_host = placed_.map.keyframes[i].id == image.id;
    for (std::size_t k = first_point_[i]; k < first_point_[i + 1]; ++k) {
      const Eigen::Vector3d p = candidate.S_camera_host * points_[k].in_host;
      if (!(p.z() > 0)) continue;
      candidate.point = k;
      candidate.predicted = project(camera_, p);
      if (is_inside(candidate.predicted, camera_)) found.push_back(candidate);
    }
  }
  return found;
}

std::optional<Eigen::Vector2d> PointTracks::look_for(const Candidate& candidate, const TrackedImage& image,
                                                     const Image<Texel>& texels) const {
  const Point& point = points_[candidate.point];
  const Sim3d& S = candidate.S_camera_host;
  const double depth = point.in_host.z(), idepth = 1 / (S * point.in_host).z();
  const Eigen::Vector2d expected = with_readout(camera_, image.motion, candidate.predicted, idepth);
  if (candidate.is_host) return expected;
  const Eigen::Vector3d centre = S * (depth * viewing_ray(camera_, point.centre)).eval();
  const Eigen::Matrix2d warp = warp_at(camera_, S, point.centre, depth);
  if (!(centre.z() > 0) || !is_comparable(warp)) return std::nullopt;
  const Eigen::Vector2d start = with_readout(camera_, image.motion, project(camera_, centre), 1 / centre.z());
  const std::optional<PatchPosition> found = align_patch(point.patch, texels, start, warp);
  if (!found) return std::nullopt;
  return expected + (found->pixel - start);
}

std::vector<Sighting> PointTracks::find(const TrackedImage& image) {
  const PreparedFrame prepared = prepare(image);
  const Image<Texel>& texels = prepared.pyramid.levels.front();
  const std::vector<Candidate> expected = candidates(image);
  std::vector<std::optional<Eigen::Vector2d>> places(expected.size());
  pool_.for_chunks(static_cast<int>(expected.size()), kPointsPerChunk, [&](int, int begin, int end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      places[i] = look_for(expected[i], image, texels);
  });
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (places[i] && places[i]->allFinite())
      sightings.push_back({expected[i].point, expected[i].predicted, *places[i]});
  }
  return sightings;
}

}  // namespace ldso
