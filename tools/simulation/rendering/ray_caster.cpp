#include "simulation/rendering/ray_caster.h"

#include <algorithm>

#include "ldso/error.h"
#include "simulation/rendering/ray_block.h"

namespace ldso::simulation {

void RayCaster::render(const std::vector<SE3d>& row_poses, const RenderTarget& target, ThreadPool* pool) const {
  const int width = rays_.width(), height = rays_.height();
  const bool rolling = row_poses.size() > 1;
  if (row_poses.empty() || (rolling && static_cast<int>(row_poses.size()) != height)) {
    throw Error("ray caster", "needs one pose, or one for each row", "");
  }
  if (target.radiance != nullptr) *target.radiance = Image<float>(width, height);
  if (target.depth != nullptr) *target.depth = Image<float>(width, height);
  const int block_columns = RayBlock::kMaxColumns - 2;
  const int block_rows = rolling ? 1 : RayBlock::kMaxRows - 2;
  const int across = (width + block_columns - 1) / block_columns;
  const int down = (height + block_rows - 1) / block_rows;
  const auto render_block = [&](int i) {
    const int left = (i % across) * block_columns, top = (i / across) * block_rows;
    RayBlock block(scene_, rays_, left, top, std::min(block_columns, width - left), std::min(block_rows, height - top));
    block.trace(row_poses[rolling ? top : 0]);
    BlockShader(scene_, block).shade(target);
  };
  if (pool != nullptr) {
    pool->run(across * down, render_block);
  } else {
    for (int i = 0; i < across * down; ++i) render_block(i);
  }
}

}  // namespace ldso::simulation
