#include "odometry/selection/point_selector.h"

#include <string>

#include "ldso/error.h"
#include "odometry/selection/corner_selector.h"
#include "odometry/selection/gradient_selector.h"
#include "odometry/selection/random_selector.h"

namespace ldso {
namespace {

void require(bool in_range, const std::string& name, double value, const std::string& remedy) {
  if (!in_range) throw Error("selection." + name, "is " + std::to_string(value), remedy);
}

void check(const SelectionSettings& s) {
  require(s.corner_quality >= 0 && s.corner_quality < 1, "corner_quality", s.corner_quality, "give 0 to below 1");
  require(s.corner_radius >= 1, "corner_radius", s.corner_radius, "give at least 1");
  require(s.corner_cell >= 1, "corner_cell", s.corner_cell, "give at least 1");
  require(s.gradient_threshold >= 0, "gradient_threshold", s.gradient_threshold, "give 0 or more");
  require(s.block_size >= 4, "block_size", s.block_size, "give at least 4");
}

}  // namespace

void check_pyramid(const ImagePyramid& pyramid, std::int64_t frame_id) {
  if (!pyramid.levels.empty() && !pyramid.levels[0].empty()) return;
  throw Error("frame " + std::to_string(frame_id), "has no image to select points from", "build its pyramid first");
}

std::unique_ptr<PointSelector> make_point_selector(const SelectionSettings& settings) {
  check(settings);
  switch (settings.strategy) {
    case SelectionStrategy::kCorners:
      return std::make_unique<CornerSelector>(settings);
    case SelectionStrategy::kGradient:
      return std::make_unique<GradientSelector>(settings);
    case SelectionStrategy::kRandom:
      return std::make_unique<RandomSelector>(settings);
  }
  throw Error("selection.strategy", "is unknown", "give corners, gradient or random");
}

}  // namespace ldso
