#pragma once

// Idea: the rays of a camera, once for all its images.

#include <Eigen/Core>
#include <functional>

#include "ldso/image.h"

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

}  // namespace ldso::simulation
