#include "odometry/selection/gradient_candidates.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "odometry/selection/selection_kernels.h"

namespace ldso {
namespace {

// By how much thresholds fall from scale to scale (DSO section 3.2 lowers them, without a number).
constexpr double kFactorPerScale = 0.75;

// Strongest usable base pixel of the square that the coarse pixel (x, y) covers. The bits of a float order like an
// integer, and unusable ones are negative; the place in the square takes the lowest bits, so that no branch is needed.
template <int kShift>
bool strongest_below(const Image<float>& base, int x, int y, GradientCandidate* found) {
  constexpr int kSide = 1 << kShift;
  constexpr std::int32_t kPlaces = kSide * kSide - 1;
  std::int32_t best = -1;
  for (int j = 0; j < kSide; ++j) {
    const float* row = base.row((y << kShift) + j) + (x << kShift);
    for (int i = 0; i < kSide; ++i) {
      const std::int32_t key = (std::bit_cast<std::int32_t>(row[i]) & ~kPlaces) | (j * kSide + i);
      best = std::max(best, key);
    }
  }
  found->x = static_cast<std::uint16_t>((x << kShift) + (best & kPlaces) % kSide);
  found->y = static_cast<std::uint16_t>((y << kShift) + (best & kPlaces) / kSide);
  return best >= 0;
}

class CandidateCollector {
 public:
  CandidateCollector(const GradientScales& scales, int index, double added_threshold)
      : scales_(scales),
        scale_(scales.scales[index]),
        base_(*scales.scales[0].squared),
        added_(static_cast<float>(added_threshold)),
        factor_(static_cast<float>(std::pow(kFactorPerScale, index))),
        width_(std::min(scale_.squared->width(), base_.width() >> scale_.shift)),
        thresholds_(width_),
        indices_(width_) {}

  std::vector<GradientCandidate> collect() {
    const int height = std::min(scale_.squared->height(), base_.height() >> scale_.shift);
    candidates_.reserve(scale_.squared->size() / 4);
    int block_row = -1;
    for (int y = 0; y < height; ++y) {
      if ((y << scale_.shift) / scales_.block_size != block_row) set_thresholds(++block_row);
      const int found = find_above(scale_.squared->row(y), thresholds_.data(), width_, indices_.data());
      append_row(y, found);
    }
    return std::move(candidates_);
  }

 private:
  void set_thresholds(int block_row) {
    for (int x = 0; x < width_; ++x) {
      const float median = scales_.medians((x << scale_.shift) / scales_.block_size, block_row);
      const float threshold = (median + added_) * factor_;
      thresholds_[x] = threshold * threshold;
    }
  }

  void append_row(int y, int found) {
    const std::size_t before = candidates_.size();
    candidates_.resize(before + found);
    GradientCandidate* end = candidates_.data() + before;
    for (int i = 0; i < found; ++i) {
      if (at_base(indices_[i], y, end)) ++end;
    }
    candidates_.resize(end - candidates_.data());
  }

  bool at_base(int x, int y, GradientCandidate* found) const {
    if (scale_.shift == 1) return strongest_below<1>(base_, x, y, found);
    if (scale_.shift == 2) return strongest_below<2>(base_, x, y, found);
    *found = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
    return true;
  }

  const GradientScales& scales_;
  const GradientScales::Scale scale_;
  const Image<float>& base_;
  const float added_;
  const float factor_;
  const int width_;
  std::vector<float> thresholds_;
  std::vector<std::int32_t> indices_;
  std::vector<GradientCandidate> candidates_;
};

}  // namespace

std::vector<GradientCandidate> gradient_candidates(const GradientScales& scales, int index, double added_threshold) {
  return CandidateCollector(scales, index, added_threshold).collect();
}

}  // namespace ldso
