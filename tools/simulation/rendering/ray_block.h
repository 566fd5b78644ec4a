#pragma once

// Idea: the rays of a small block of pixels share one traversal of the scene. Testing a surface against all of them is
// a short loop without branches, as all that is asked is linear in the ray.

#include <array>
#include <vector>

#include "ldso/se3.h"
#include "simulation/rendering/camera_rays.h"
#include "simulation/rendering/scene.h"
#include "simulation/rendering/seen_surface.h"

namespace ldso::simulation {

/// Change of the ray (x, y) for one pixel to the right and one pixel down.
struct RayChange {
  Eigen::Vector2f d_du, d_dv;
};

/// The rays of a block of pixels with a border of one pixel, and what they hit. Columns and rows count from the border.
class RayBlock {
 public:
  static constexpr int kMaxColumns = 32, kMaxRows = 16;  ///< With the border.
  static constexpr float kNoRay = 1e30f;

  /// A block of `columns` x `rows` pixels without its border. What is referred to must live as long.
  RayBlock(const Scene& scene, const CameraRays& rays, int left, int top, int columns, int rows);

  void trace(const SE3d& T_world_camera);

  int left() const { return left_; }  ///< Of the first pixel inside the border.
  int top() const { return top_; }
  int columns() const { return columns_; }  ///< With the border.
  int rows() const { return rows_; }
  static int index(int column, int row) { return row * kMaxColumns + column; }

  float x(int index) const { return x_[index]; }
  float y(int index) const { return y_[index]; }
  /// Of what the ray hits; 0: nothing, kNoRay: the camera sees nothing there.
  float inverse_depth(int index) const { return best_[index]; }
  /// What the ray hits, an index in seen(); -1: the sky.
  int hit(int index) const { return hit_[index]; }
  /// All surfaces that may appear in the block.
  const std::vector<SeenSurface>& seen() const { return seen_; }
  /// In the middle of the block, and at one pixel.
  const RayChange& change() const { return change_; }
  RayChange change_at(int column, int row) const;
  const Eigen::Matrix3d& R_world_camera() const { return R_; }

 private:
  static constexpr int kMaxRays = kMaxColumns * kMaxRows;

  void load_rays();
  Eigen::Vector2f ray(int column, int row) const;
  void traverse();
  /// Planes through the camera that bound the block, pointing inwards.
  void bound();
  /// False if the box is outside of the block's frustum; `z`: a lower bound of its depth.
  bool node_visible(int index, float& z) const;
  void visit(int surface_index);
  /// Tests the corners against the frustum; finds the rows the surface can appear in.
  bool in_frustum(const Surface& s, const Eigen::Vector3d& o, SeenSurface& seen) const;
  /// Where the surface is nearer than what was found, takes it. True if it was taken anywhere.
  template <bool kTriangle>
  bool test(const SeenSurface& s, int id);
  void update_farthest();

  const Scene& scene_;
  const CameraRays& rays_;
  int left_, top_, columns_, rows_;
  SE3d T_world_camera_;
  Eigen::Matrix3d R_;
  std::array<float, kMaxRays> x_, y_;
  std::array<float, kMaxRays> best_;  ///< Inverse depth.
  std::array<int, kMaxRays> hit_;
  std::array<float, kMaxRows> row_low_, row_high_;
  Eigen::Vector2f low_, high_;
  RayChange change_;
  std::array<Eigen::Vector3f, 4> planes_;
  Eigen::Vector3f axis_, position_;
  float farthest_ = 0;  ///< Least inverse depth of the block.
  std::vector<SeenSurface> seen_;
};

}  // namespace ldso::simulation
