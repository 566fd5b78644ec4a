#include "mapping/map/local_map.h"

namespace ldso {
namespace {

void add_points(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe, const SE3d& T_local_host,
                std::vector<LocalPoint>& points) {
  const std::vector<MapFeature>& features = map[keyframe].features;
  for (int i = 0; i < static_cast<int>(features.size()); ++i) {
    if (!(features[i].idepth > 0)) continue;
    points.push_back({keyframe, i, T_local_host, Sim3d(T_local_host) * own_point(map, camera, keyframe, i)});
  }
}

}  // namespace

UncertainPoint own_point(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe, int feature) {
  const MapFeature& f = map[keyframe].features[feature];
  // The host pixel of a direct method is exact: its depth belongs to that very pixel.
  return back_project(camera, {f.feature.u, f.feature.v}, 0.0, f.idepth, f.idepth_stddev);
}

void add_points_of_neighbours(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe,
                              std::vector<LocalPoint>& points) {
  for (const Neighbour& neighbour : map[keyframe].neighbours) {
    add_points(map, camera, neighbour.index, neighbour.T_this_other, points);
  }
}

std::vector<LocalPoint> own_points(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe) {
  std::vector<LocalPoint> points;
  add_points(map, camera, keyframe, SE3d(), points);
  return points;
}

std::vector<LocalPoint> local_map(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe) {
  std::vector<LocalPoint> points = own_points(map, camera, keyframe);
  add_points_of_neighbours(map, camera, keyframe, points);
  return points;
}

}  // namespace ldso
