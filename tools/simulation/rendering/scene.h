#pragma once

// Idea: a world is a set of textured parallelograms and triangles under a distant sky, with a bounding volume
// hierarchy over them.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "simulation/rendering/texture.h"

namespace ldso::simulation {

/// How a texture lies on a surface: texel = (s0 + u * s_u, t0 + v * t_v) for the surface coordinates (u, v).
struct TextureMapping {
  int texture = -1;
  float s0 = 0, t0 = 0;
  float s_u = 0, t_v = 0;  ///< Texels along edge_u and edge_v.
};

/// The points origin + u * edge_u + v * edge_v, 0 <= u, v <= 1 (u + v <= 1 for a triangle). It is seen from the side
/// from which u runs to the right and v down, that is where edge_u x edge_v points away from the viewer.
struct Surface {
  static constexpr std::uint8_t kAllSharp = 0xf;

  Eigen::Vector3d origin, edge_u, edge_v;
  bool triangle = false;
  bool two_sided = false;
  /// Which edges end the surface visibly: bits 0..3 for u = 0, v = 0, u = 1 (or u + v = 1), v = 1.
  std::uint8_t sharp_edges = kAllSharp;
  TextureMapping base;
  TextureMapping detail;  ///< Optional: its deviation from `detail_mean` is added.
  float detail_gain = 0;
  float gain = 1;  ///< Light that falls on the surface.
  int group = -1;  ///< Surfaces of a group continue each other smoothly. Set by Scene::add if negative.
};

/// Node of the hierarchy: children `first`, `first + 1`, or `count` surfaces from order[first].
struct BvhNode {
  Eigen::Vector3f low, high;
  int first = 0;
  int count = 0;
};

class Scene {
 public:
  /// Mean value of all detail textures.
  static constexpr float kDetailMean = 0.5f;

  int add_texture(Texture texture);
  void set_texture(int index, Texture texture) { textures_[index] = std::move(texture); }
  void add(Surface surface);
  /// Builds the hierarchy; call when all surfaces are there.
  void finish();

  /// The sky: longitude along s over one turn, t from the zenith to the nadir. At infinity.
  void set_sky(int texture) { sky_ = texture; }
  int sky() const { return sky_; }

  const Texture& texture(int index) const { return textures_[index]; }
  Texture& texture(int index) { return textures_[index]; }
  const std::vector<Surface>& surfaces() const { return surfaces_; }
  const std::vector<BvhNode>& nodes() const { return nodes_; }
  const std::vector<int>& order() const { return order_; }

 private:
  void build(int node, int begin, int end);

  std::vector<Texture> textures_;
  std::vector<Surface> surfaces_;
  std::vector<BvhNode> nodes_;
  std::vector<int> order_;
  int sky_ = -1;
};

}  // namespace ldso::simulation
