#pragma once

// Idea: a pixel shows what its ray hits; pixels that an outline or a crease passes are sampled many times.

#include <array>
#include <cstdint>

#include "ldso/image.h"
#include "simulation/rendering/ray_block.h"
#include "simulation/rendering/scene.h"

namespace ldso::simulation {

struct RenderTarget {
  Image<float>* radiance = nullptr;  ///< In units of the textures, about 0..1.
  Image<float>* depth = nullptr;     ///< z [m] at the pixel centre, 0 for the sky.
};

class BlockShader {
 public:
  /// `block` is traced. What is referred to must live as long.
  BlockShader(const Scene& scene, const RayBlock& block) : scene_(scene), block_(block) { find_mixed_pixels(); }

  /// Fills the pixels of the block, without its border.
  void shade(const RenderTarget& target) const;

 private:
  int group_of(int index) const;
  /// Marks the pixels that show more than one surface.
  void find_mixed_pixels();
  /// Outlines of surfaces that no pixel centre may have hit (thin poles).
  void mark_outline(const SeenSurface& s);

  float radiance(int column, int row) const;
  /// Mean over the surfaces in the pixel, each looked up once, where it is seen, and weighted with what it covers.
  float mixed_radiance(float x, float y, const RayChange& change) const;
  /// Surfaces that any subsample of the pixel can see.
  int surfaces_near(float x, float y, const RayChange& change, const SeenSurface** near) const;

  const Scene& scene_;
  const RayBlock& block_;
  std::array<bool, RayBlock::kMaxColumns * RayBlock::kMaxRows> mixed_{};
};

}  // namespace ldso::simulation
