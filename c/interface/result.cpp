// What a run has found.

#include <algorithm>
#include <memory>

#include "interface/guard.h"
#include "interface/pose.h"
#include "ldso/io/result_files.h"

using ldso::c::guarded;
using ldso::c::require;

extern "C" {

size_t ldso_result_poses(const ldso_result* result, ldso_pose* poses, size_t most) {
  if (result == nullptr) return 0;
  const size_t count = poses != nullptr ? std::min(most, result->poses.size()) : 0;
  for (size_t i = 0; i < count; ++i) poses[i] = ldso::c::to_pose(result->poses[i]);
  return result->poses.size();
}

size_t ldso_result_points(const ldso_result* result, ldso_point* points, size_t most) {
  if (result == nullptr) return 0;
  const size_t count = points != nullptr ? std::min(most, result->points.size()) : 0;
  for (size_t i = 0; i < count; ++i) {
    const ldso::WorldPoint& p = result->points[i];
    points[i] = {p.position.x(), p.position.y(), p.position.z(), p.intensity, p.idepth_stddev, p.keyframe_id};
  }
  return result->points.size();
}

int ldso_result_restarts(const ldso_result* result) { return result != nullptr ? result->result.restarts : 0; }

ldso_calibration* ldso_result_better_calibration(const ldso_result* result) {
  return guarded<ldso_calibration*>(nullptr, [&]() -> ldso_calibration* {
    require(result, "result");
    if (!result->result.better_calibration) return nullptr;
    return std::make_unique<ldso_calibration>(ldso_calibration{*result->result.better_calibration}).release();
  });
}

ldso_status ldso_result_write_tum(const ldso_result* result, const char* path) {
  return guarded(LDSO_ERROR, [&] {
    require(result, "result");
    require(path, "path");
    ldso::write_tum_trajectory(path, ldso::to_trajectory(result->poses));
    return LDSO_OK;
  });
}

ldso_status ldso_result_write_ply(const ldso_result* result, const char* path) {
  return guarded(LDSO_ERROR, [&] {
    require(result, "result");
    require(path, "path");
    ldso::write_ply(path, ldso::to_cloud(result->points));
    return LDSO_OK;
  });
}

void ldso_result_free(ldso_result* result) { delete result; }
}
