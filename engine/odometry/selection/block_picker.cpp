#include "odometry/selection/block_picker.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "util/hash.h"

namespace ldso {
namespace {

// Directions that a block may prefer, evenly over half a turn.
constexpr int kDirections = 16;

struct Direction {
  float x, y;
};

// Over half a turn: the sign of the gradient does not matter.
std::array<Direction, kDirections> make_directions() {
  std::array<Direction, kDirections> directions{};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    directions[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return directions;
}

std::vector<int> block_of_pixel(int pixels, double block_side) {
  std::vector<int> blocks(pixels);
  for (int i = 0; i < pixels; ++i) blocks[i] = static_cast<int>(i / block_side);
  return blocks;
}

// A grid of twice the block side; a block is taken if one of its four parts is.
Image<std::uint8_t> coarser(const Image<std::uint8_t>& taken) {
  Image<std::uint8_t> result((taken.width() + 1) / 2, (taken.height() + 1) / 2, 0);
  for (int y = 0; y < taken.height(); ++y) {
    for (int x = 0; x < taken.width(); ++x) result(x / 2, y / 2) |= taken(x, y);
  }
  return result;
}

struct BestOfBlock {
  Direction direction{};
  float response = -1;
  const GradientCandidate* candidate = nullptr;
};

}  // namespace

/// Blocks of one side: which are taken, at the scale reached so far.
class BlockPicker::Grid {
 public:
  Grid(int width, int height, double block_side)
      : column_(block_of_pixel(width, block_side)),
        row_(block_of_pixel(height, block_side)),
        taken_(column_.back() + 1, row_.back() + 1, 0) {}

  int count(const std::vector<GradientCandidate>& candidates) {
    int picks = 0;
    for (const GradientCandidate& candidate : candidates) {
      std::uint8_t& taken = taken_(column_[candidate.x] >> scale_, row_[candidate.y] >> scale_);
      picks += 1 - taken;
      taken = 1;
    }
    return picks;
  }

  void pick(const std::vector<GradientCandidate>& candidates, const GradientScales::Scale& scale, std::uint64_t seed,
            std::vector<SelectedPixel>* picks) {
    std::vector<BestOfBlock> best = empty_blocks(seed);
    for (const GradientCandidate& candidate : candidates) {
      BestOfBlock& block = best[block_index(candidate)];
      const Texel& texel = (*scale.level)(candidate.x >> scale.shift, candidate.y >> scale.shift);
      const float response = std::abs(texel.dx * block.direction.x + texel.dy * block.direction.y);
      if (response > block.response) block = {block.direction, response, &candidate};
    }
    for (std::size_t i = 0; i < best.size(); ++i) {
      if (best[i].candidate == nullptr) continue;
      picks->push_back({best[i].candidate->x, best[i].candidate->y, false, static_cast<float>(1 << scale_)});
      taken_.data()[i] = 1;
    }
  }

  void go_to_coarser_scale() {
    taken_ = coarser(taken_);
    ++scale_;
  }

 private:
  // Taken blocks get a response that no candidate exceeds.
  std::vector<BestOfBlock> empty_blocks(std::uint64_t seed) const {
    static const std::array<Direction, kDirections> kDirectionTable = make_directions();
    std::vector<BestOfBlock> blocks(taken_.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      blocks[i].direction = kDirectionTable[hash_of(i, seed) % kDirections];
      if (taken_.data()[i]) blocks[i].response = std::numeric_limits<float>::infinity();
    }
    return blocks;
  }

  std::size_t block_index(const GradientCandidate& candidate) const {
    return static_cast<std::size_t>(row_[candidate.y] >> scale_) * taken_.width() + (column_[candidate.x] >> scale_);
  }

  std::vector<int> column_;
  std::vector<int> row_;
  Image<std::uint8_t> taken_;
  int scale_ = 0;
};

BlockPicker::BlockPicker(GradientScales scales, double added_threshold) : scales_(std::move(scales)) {
  for (int i = 0; i < static_cast<int>(scales_.scales.size()); ++i) {
    candidates_.push_back(gradient_candidates(scales_, i, added_threshold));
  }
}

int BlockPicker::count(double block_side) const {
  const Image<float>& base = *scales_.scales[0].squared;
  Grid grid(base.width(), base.height(), block_side);
  int picks = 0;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i > 0) grid.go_to_coarser_scale();
    picks += grid.count(candidates_[i]);
  }
  return picks;
}

std::vector<SelectedPixel> BlockPicker::pick(double block_side, std::uint64_t seed) const {
  const Image<float>& base = *scales_.scales[0].squared;
  Grid grid(base.width(), base.height(), block_side);
  std::vector<SelectedPixel> picks;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i > 0) grid.go_to_coarser_scale();
    grid.pick(candidates_[i], scales_.scales[i], hash_of(i, seed), &picks);
  }
  return picks;
}

}  // namespace ldso
