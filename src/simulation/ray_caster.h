#pragma once

// Idea: the rays of a small block of pixels share one traversal of the scene. A surface's inverse depth and its
// surface coordinates times inverse depth are linear in the ray direction (x, y, 1), so testing it against all rays of
// the block is a short loop without branches. Pixels that an outline or a crease passes are sampled many times.

#include <functional>
#include <vector>

#include "ldso/image.h"
#include "ldso/se3.h"
#include "simulation/scene.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

/// Directions (x, y, 1) of the rays through all pixel centres, and one pixel beyond the border.
class CameraRays {
 public:
  /// Direction of a pixel, possibly outside of the image; NaN where the camera sees nothing.
  using Unproject = std::function<Eigen::Vector2d(double u, double v)>;
  CameraRays(int width, int height, const Unproject& unproject);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Ray of pixel (u, v), -1 <= u <= width, -1 <= v <= height.
  float x(int u, int v) const { return x_(u + 1, v + 1); }
  float y(int u, int v) const { return y_(u + 1, v + 1); }

 private:
  int width_, height_;
  Image<float> x_, y_;
};

struct RenderTarget {
  Image<float>* radiance = nullptr;  ///< In units of the textures, about 0..1.
  Image<float>* depth = nullptr;     ///< z [m] at the pixel centre, 0 for the sky.
};

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
