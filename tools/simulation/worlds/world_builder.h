#pragma once

// Idea: the tools all worlds are built with. Textures are painted later, all at once and in parallel; boxes and other
// solids are put together from surfaces; light from a fixed direction is painted into them.

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "simulation/rendering/scene.h"
#include "simulation/worlds/camera_path.h"
#include "simulation/worlds/canvas.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

struct World {
  Scene scene;
  std::unique_ptr<CameraPath> path;
  std::string name;
  double light = 1;  ///< Share of the usual irradiance; no exposure makes up for the rest.
};

/// What covers a surface: a texture stretched over it, or a repeating one with a scale and a seeded offset.
struct Skin {
  int texture = -1;
  double texels_per_metre = 0;  ///< 0: stretched.
  float detail_gain = 0.12f;    ///< Strength of the fine structure on top.
  float gain = 1;
};

/// The six sides of a box.
struct BoxSkins {
  Skin front, back, left, right, top, bottom;
  static BoxSkins all(const Skin& skin) { return {skin, skin, skin, skin, skin, skin}; }
};

/// An upright box: `centre`, half sizes along its own axes, turned by `yaw` about the vertical. Its front looks against
/// its own z axis (yaw 0: -z), its top upwards (-y).
struct BoxShape {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double yaw = 0;
};

class WorldBuilder {
 public:
  /// `texel_scale` > 1 makes all textures coarser (for tests).
  WorldBuilder(std::uint64_t seed, double texel_scale);

  /// Reserves a texture that is painted by finish(). Sizes in metres.
  int paint(double width, double height, double texel, std::function<void(Canvas&)> painter);
  int foliage() const { return foliage_; }
  double texel_scale() const { return texel_scale_; }

  void quad(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
            const Skin& skin, bool two_sided = false);
  void triangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                const Skin& skin);
  /// A face with an empty skin (texture -1) is left out.
  void box(const BoxShape& shape, const BoxSkins& skins);
  /// A lump of leaves: an icosahedron with displaced corners.
  void bush(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii);

  Scene& scene() { return scene_; }
  /// Paints, builds the hierarchy, hands the scene over. `pool` may be null.
  Scene finish(ThreadPool* pool);

 private:
  struct Job {
    int texture;
    double width, height, texel;
    std::function<void(Canvas&)> painter;
  };
  TextureMapping map(const Skin& skin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v);
  void add(Surface surface, const Skin& skin);

  Random random_;
  double texel_scale_;
  Scene scene_;
  std::vector<Job> jobs_;
  int detail_ = -1, foliage_ = -1;
  std::vector<Canvas::Size> sizes_;  ///< Of the painted textures, by index.
};

/// Light on a surface with this outward normal, about 0.5..1.
float light_on(const Eigen::Vector3d& outward_normal);

}  // namespace ldso::simulation
