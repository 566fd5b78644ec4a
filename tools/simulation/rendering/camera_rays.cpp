#include "simulation/rendering/camera_rays.h"

namespace ldso::simulation {

CameraRays::CameraRays(int width, int height, const Unproject& unproject)
    : width_(width), height_(height), x_(width + 2, height + 2), y_(width + 2, height + 2) {
  for (int v = -1; v <= height; ++v) {
    for (int u = -1; u <= width; ++u) {
      const Eigen::Vector2d ray = unproject(u, v);
      x_(u + 1, v + 1) = static_cast<float>(ray.x());
      y_(u + 1, v + 1) = static_cast<float>(ray.y());
    }
  }
}

}  // namespace ldso::simulation
