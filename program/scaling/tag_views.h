#pragma once
// Where a tag of known size is seen.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "ldso/se3.h"
#include "scaling/metric_scale.h"

namespace ldso {

/// A tag in one image with a pose.
struct TagView {
  SE3d T_world_camera;
  /// To its corners, in the camera, of length 1; in the order in which they go round.
  std::array<Eigen::Vector3d, 4> rays;
  double ray_stddev = 0;  ///< Of each ray, by the precision of a corner in the image [rad].
};

/// Looks for it in images of frames with a pose in the main map, all over the sequence. Images that cannot be read are
/// passed over.
std::vector<TagView> find_tag(const AprilTag& tag, const SlamResult& result, const Calibration& calibration,
                              const Dataset& dataset);

}  // namespace ldso
