#pragma once

// Idea: seen from one place, a surface's inverse depth and its surface coordinates times inverse depth are linear in
// the ray direction (x, y, 1); so are, then, its boundaries.

#include <Eigen/Core>
#include <cmath>

namespace ldso::simulation {

/// Linear function of the ray direction: a * x + b * y + c.
struct LinearForm {
  float a = 0, b = 0, c = 0;
  float operator()(float x, float y) const { return a * x + b * y + c; }
};

/// Inverse depth w, and u * w, v * w, as functions of the ray.
struct SeenSurface {
  LinearForm w, uw, vw;
  int surface = 0;  ///< Its index in the scene.
  bool triangle = false;
  int row_begin = 0, row_end = 0;  ///< Rows of the block it can appear in.
};

/// Boundaries of a surface as four forms that are positive inside.
struct EdgeValues {
  float value[4];
};

inline EdgeValues edges(const SeenSurface& s, float x, float y) {
  const float w = s.w(x, y), uw = s.uw(x, y), vw = s.vw(x, y);
  if (s.triangle) return {{uw, vw, w - uw - vw, w - uw - vw}};
  return {{uw, vw, w - uw, w - vw}};
}

/// How far each boundary form moves over the reach of the subsamples of a mixed pixel, given the change of
/// the ray per pixel.
inline EdgeValues edge_margins(const SeenSurface& s, const Eigen::Vector2f& d_du, const Eigen::Vector2f& d_dv) {
  constexpr float kReach = 1.02f;  // The subsamples reach one pixel to all sides.
  const auto reach = [&](float a, float b) {
    return kReach * (std::abs(a * d_du.x() + b * d_du.y()) + std::abs(a * d_dv.x() + b * d_dv.y()));
  };
  const LinearForm& w = s.w;
  const LinearForm& u = s.uw;
  const LinearForm& v = s.vw;
  const float far_u = s.triangle ? reach(w.a - u.a - v.a, w.b - u.b - v.b) : reach(w.a - u.a, w.b - u.b);
  const float far_v = s.triangle ? far_u : reach(w.a - v.a, w.b - v.b);
  return {{reach(u.a, u.b), reach(v.a, v.b), far_u, far_v}};
}

}  // namespace ldso::simulation
