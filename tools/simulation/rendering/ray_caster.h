#pragma once

// Idea: an image of a scene, block by block of pixels that share one traversal.

#include <vector>

#include "ldso/se3.h"
#include "simulation/rendering/block_shader.h"
#include "simulation/rendering/camera_rays.h"
#include "simulation/rendering/scene.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

class RayCaster {
 public:
  RayCaster(const Scene& scene, const CameraRays& rays) : scene_(scene), rays_(rays) {}

  /// `row_poses`: camera-to-world, one for all rows or one for each row (rolling shutter). The images of the target are
  /// allocated here. `pool` may be null. The result does not depend on the number of threads.
  void render(const std::vector<SE3d>& row_poses, const RenderTarget& target, ThreadPool* pool) const;

 private:
  const Scene& scene_;
  const CameraRays& rays_;
};

}  // namespace ldso::simulation
