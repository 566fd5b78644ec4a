#include "scaling/metric_scale.h"

#include <cmath>

#include "ldso/error.h"
#include "scaling/ground_height.h"
#include "scaling/tag_views.h"
#include "scaling/triangulated_tag.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// A tag that is known worse is seen from one direction only.
constexpr double kMostTagDeviation = 0.05;

void check_length(double metres, const std::string& option) {
  if (!(metres > 0) || !std::isfinite(metres))
    throw Error(option, format_text("%g is no length", metres), "give metres, more than 0");
}

ScaleEstimate from_distance(const KnownDistance& known, const SlamResult& result) {
  ScaleEstimate estimate;
  estimate.source = format_text("%g m between frames %d and %d", known.metres, known.frame_a, known.frame_b);
  std::optional<Eigen::Vector3d> a, b;
  for (const TimedPose& pose : result.trajectory()) {
    if (pose.frame_id == known.frame_a) a = pose.T_world_camera.translation();
    if (pose.frame_id == known.frame_b) b = pose.T_world_camera.translation();
  }
  if (!a || !b) {
    estimate.problem = format_text("frame %d has no pose in the main map", !a ? known.frame_a : known.frame_b);
    return estimate;
  }
  const double length = (*a - *b).norm();
  if (!(length > 0)) {
    estimate.problem = "the camera is at the same place in both frames";
    return estimate;
  }
  estimate.metres_per_unit = known.metres / length;
  estimate.measurements = 1;
  return estimate;
}

ScaleEstimate from_tag(const AprilTag& known, const SlamResult& result, const Calibration& calibration,
                       const Dataset& dataset) {
  ScaleEstimate estimate;
  estimate.source = format_text("tag %s:%d of %g m", known.family.c_str(), known.id, known.metres);
  const std::vector<TagView> views = find_tag(known, result, calibration, dataset);
  estimate.measurements = static_cast<int>(views.size());
  const std::optional<TriangulatedTag> tag = triangulate_tag(views);
  if (!tag) {
    estimate.problem = format_text("the tag is found in %zu images with a pose, which is too few", views.size());
    return estimate;
  }
  if (tag->relative_stddev > kMostTagDeviation) {
    estimate.problem = format_text(
        "the size of the tag in the map is only known within %.0f %%: it is seen from one "
        "direction, or too small",
        100 * tag->relative_stddev);
    return estimate;
  }
  estimate.metres_per_unit = known.metres / tag->side;
  estimate.relative_stddev = tag->relative_stddev;
  return estimate;
}

ScaleEstimate from_height(const KnownHeight& known, const SlamResult& result) {
  ScaleEstimate estimate;
  estimate.source = format_text("the camera %g m above the ground", known.metres);
  const std::optional<GroundHeight> ground = measure_ground(result);
  if (!ground) {
    estimate.problem = "no ground is found below the camera on enough of the way";
    return estimate;
  }
  estimate.metres_per_unit = known.metres / ground->height;
  estimate.relative_stddev = ground->relative_stddev;
  estimate.measurements = ground->stretches;
  estimate.drift = 1 / ground->growth;
  return estimate;
}

}  // namespace

void check_request(const ScaleRequest& request, int frames) {
  if (request.height) check_length(request.height->metres, "--scale-height");
  if (!request.distance) return;
  const KnownDistance& distance = *request.distance;
  check_length(distance.metres, "--scale");
  for (const int frame : {distance.frame_a, distance.frame_b}) {
    if (frame < 0 || (frames > 0 && frame >= frames))
      throw Error("--scale", format_text("there is no frame %d", frame),
                  format_text("frames are counted from 0 to %d as they are played", frames - 1));
  }
  if (distance.frame_a == distance.frame_b)
    throw Error("--scale", "both frames are the same one", "give two frames with the camera at different places");
}

ScaleEstimate estimate_scale(const ScaleRequest& request, const SlamResult& result, const Calibration& calibration,
                             const Dataset& dataset) {
  if (request.distance) return from_distance(*request.distance, result);
  if (request.tag) return from_tag(*request.tag, result, calibration, dataset);
  if (request.height) return from_height(*request.height, result);
  return {};
}

}  // namespace ldso
