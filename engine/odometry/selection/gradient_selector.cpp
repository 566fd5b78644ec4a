#include "odometry/selection/gradient_selector.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "odometry/selection/block_picker.h"
#include "odometry/selection/gradient_map.h"
#include "util/hash.h"

namespace ldso {
namespace {

/// Sizes of blocks: d, 2 d and 4 d (DSO section 3.2).
constexpr int kScales = 3;
// The count is met if it is in [wanted, kAcceptedExcess * wanted]; what is above is dropped at random.
constexpr double kAcceptedExcess = 1.08;
// Sides of blocks that are tried for it.
constexpr int kSearchSteps = 8;
// Closer points see the same pattern: before blocks become smaller, thresholds are lowered.
constexpr double kLeastBlockSide = 2.0;
// Factors on the added threshold, tried in this order until the wanted number is (nearly) there.
constexpr double kThresholdRelaxations[] = {1.0, 0.5, 0.25};
// Share of the wanted number that is nearly there.
constexpr double kEnough = 0.9;

struct SidedCount {
  double side = 0;
  int count = 0;
};

// Block side whose count is accepted or, failing that, the best one found with at least `wanted` picks; `least`
// if even that gives fewer. The count falls with the side like a power between -1 (lines) and -2 (areas).
SidedCount search_block_side(const BlockPicker& picker, int wanted, double least, double guess) {
  SidedCount many;
  double few_side = std::numeric_limits<double>::infinity();
  double side = std::max(guess, least);
  for (int step = 0; step < kSearchSteps; ++step) {
    const int count = picker.count(side);
    if (count >= wanted || side <= least) {
      many = {side, count};
      if (count <= kAcceptedExcess * wanted) break;
    } else {
      few_side = side;
    }
    const double aim = 0.5 * (1 + kAcceptedExcess) * wanted;
    const double next = side * std::pow(std::max(count, 1) / aim, 1 / 1.5);
    side = next > many.side && next < few_side ? std::max(next, least) : 0.5 * (std::max(many.side, least) + few_side);
  }
  return many.side > 0 ? many : SidedCount{least, picker.count(least)};
}

// Keeps `wanted` of the picks, all with the same probability (selection sampling, Knuth, TAOCP 3.4.2, algorithm S).
std::vector<SelectedPixel> thinned_out(std::vector<SelectedPixel> picks, int wanted, std::uint64_t seed) {
  const int count = static_cast<int>(picks.size());
  if (count <= wanted) return picks;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (uniform_index(hash_of(i, seed), count - i) < wanted - kept) picks[kept++] = picks[i];
  }
  picks.resize(kept);
  return picks;
}

std::vector<SelectedPixel> pick_from_scales(const GradientScales& scales, double added_threshold, int wanted,
                                            std::uint64_t seed) {
  const Image<float>& base = *scales.scales[0].squared;
  if (wanted <= 0 || base.empty()) return {};
  const double guess = std::sqrt(0.5 * static_cast<double>(base.size()) / wanted);
  for (const double relaxation : kThresholdRelaxations) {
    const BlockPicker picker(scales, relaxation * added_threshold);
    const SidedCount found = search_block_side(picker, wanted, kLeastBlockSide, guess);
    if (found.count >= kEnough * wanted) {
      return thinned_out(picker.pick(found.side, seed), wanted, hash_of(kScales, seed));
    }
  }
  // Too little texture at any spacing: whatever exceeds the lowest thresholds.
  const BlockPicker picker(scales, kThresholdRelaxations[std::size(kThresholdRelaxations) - 1] * added_threshold);
  return thinned_out(picker.pick(1.0, seed), wanted, hash_of(kScales, seed));
}

}  // namespace

std::vector<Image<float>> selection_gradients(const ImagePyramid& pyramid) {
  std::vector<Image<float>> squared;
  squared.push_back(squared_gradients(pyramid.levels[0], kSelectionMargin, kSelectionClearance));
  const int levels = std::min(kScales, static_cast<int>(pyramid.levels.size()));
  for (int i = 1; i < levels; ++i) squared.push_back(squared_gradients(pyramid.levels[i], 1, 0));
  return squared;
}

std::vector<SelectedPixel> pick_gradient_pixels(const ImagePyramid& pyramid, const std::vector<Image<float>>& squared,
                                                const Image<float>& medians, const SelectionSettings& settings,
                                                int wanted, std::uint64_t seed) {
  GradientScales scales{{}, medians, settings.block_size};
  for (int i = 0; i < kScales; ++i) {
    const int level = std::min(i, static_cast<int>(squared.size()) - 1);
    scales.scales.push_back({&pyramid.levels[level], &squared[level], level});
  }
  return pick_from_scales(scales, settings.gradient_threshold, wanted, seed);
}

std::vector<SelectedPixel> GradientSelector::select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) {
  check_pyramid(pyramid, frame_id);
  const std::vector<Image<float>> squared = selection_gradients(pyramid);
  const Image<float> medians = block_medians(squared[0], settings_.block_size);
  return pick_gradient_pixels(pyramid, squared, medians, settings_, wanted, hash_of(frame_id, settings_.seed));
}

std::vector<SelectedPixel> select_gradient_pixels(const Image<Texel>& level, int wanted, std::uint64_t seed,
                                                  const SelectionSettings& settings) {
  const Image<float> squared = squared_gradients(level, kSelectionMargin, kSelectionClearance);
  GradientScales scales{{}, block_medians(squared, settings.block_size), settings.block_size};
  scales.scales.assign(kScales, {&level, &squared, 0});
  return pick_from_scales(scales, settings.gradient_threshold, wanted, hash_of(seed));
}

}  // namespace ldso
