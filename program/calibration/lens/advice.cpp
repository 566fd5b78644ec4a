#include "calibration/lens/advice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace ldso {
namespace {

constexpr std::size_t kEnoughViews = 15;
constexpr double kLargeRms = 0.5;         // [px] for an image of 640 pixels
constexpr double kUnsureFocal = 0.002;    // standard deviation, relative
constexpr double kCoveredRadius = 0.8;    // of the half diagonal
constexpr double kTilted = 0.26;          // [rad]
constexpr std::size_t kEnoughTilted = 4;  // views

std::string text_of(const char* format, double value) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// How many points lie in each ninth of the image, row by row.
std::array<int, 9> points_in_ninths(const LensCalibration& lens) {
  std::array<int, 9> counts{};
  for (const CalibratedView& view : lens.views) {
    for (const LensResidual& point : view.points) {
      const int column = std::clamp(static_cast<int>(3 * (point.pixel.x() + 0.5) / lens.camera.width), 0, 2);
      const int row = std::clamp(static_cast<int>(3 * (point.pixel.y() + 0.5) / lens.camera.height), 0, 2);
      ++counts[static_cast<std::size_t>(3 * row + column)];
    }
  }
  return counts;
}

/// Whole thirds first, then single ninths.
void advise_coverage(const LensCalibration& lens, std::vector<std::string>& advice) {
  std::array<int, 9> counts = points_in_ninths(lens);
  const int few = lens.point_count() / 200;
  struct Third {
    const char* name;
    std::array<std::size_t, 3> cells;
  };
  constexpr std::array<Third, 4> kThirds{
      {{"left", {0, 3, 6}}, {"right", {2, 5, 8}}, {"upper", {0, 1, 2}}, {"lower", {6, 7, 8}}}};
  const std::array<int, 9> all = counts;
  for (const Third& third : kThirds) {
    const bool is_empty = std::all_of(third.cells.begin(), third.cells.end(), [&](auto c) { return all[c] <= few; });
    if (!is_empty) continue;
    advice.push_back("No views in the " + std::string(third.name) +
                     " third of the image: take some with the board there.");
    for (const std::size_t cell : third.cells) counts[cell] = few + 1;
  }
  constexpr std::array<const char*, 9> kNinths{"upper left",   "upper middle", "upper right",  "middle left", "middle",
                                               "middle right", "lower left",   "lower middle", "lower right"};
  std::string empty;
  for (std::size_t i = 0; i < 9; ++i) {
    if (counts[i] <= few) empty += (empty.empty() ? "" : ", ") + std::string(kNinths[i]);
  }
  if (!empty.empty()) advice.push_back("Hardly any points in these parts of the image: " + empty + ".");
}

void advise_corners(const LensCalibration& lens, std::vector<std::string>& advice) {
  const Eigen::Vector2d middle(0.5 * (lens.camera.width - 1), 0.5 * (lens.camera.height - 1));
  double farthest = 0;
  for (const CalibratedView& view : lens.views) {
    for (const LensResidual& point : view.points) farthest = std::max(farthest, (point.pixel - middle).norm());
  }
  if (farthest < kCoveredRadius * middle.norm())
    advice.push_back(
        text_of("The points reach %.0f %% of the way from the middle to the corners of the image; beyond, the "
                "distortion is a guess. Bring the board into the corners.",
                100 * farthest / middle.norm()));
}

void advise_tilt(const LensCalibration& lens, std::vector<std::string>& advice) {
  std::size_t tilted = 0;
  for (const CalibratedView& view : lens.views) {
    // Between the board's normal and the ray to its middle, which is how its sides differ in distance.
    const Eigen::Vector3d normal = view.pose.rotation_matrix().col(2);
    const double cosine = std::abs(normal.dot(view.pose.translation().normalized()));
    if (std::acos(std::min(1.0, cosine)) > kTilted) ++tilted;
  }
  if (tilted < std::min(kEnoughTilted, lens.views.size()))
    advice.push_back("Only " + std::to_string(tilted) +
                     " views are tilted: focal length and distance are hard to tell apart. Tilt the board by 20 to 45 "
                     "degrees, in several directions.");
}

void advise_fit(const LensCalibration& lens, std::vector<std::string>& advice) {
  const double large = kLargeRms * std::max(640, std::max(lens.camera.width, lens.camera.height)) / 640;
  if (lens.rms > large)
    advice.push_back(
        text_of("The points are off by %.2f px: is the board flat and as it was said to be, did it stand "
                "still, is the focus fixed, is the image stabilized?",
                lens.rms));
  const auto seen = lens.views.size() + lens.refused_views.size();
  if (4 * lens.refused_views.size() > seen)
    advice.push_back(
        std::to_string(lens.refused_views.size()) + " of " + std::to_string(seen) +
        " views fit to no lens that fits to the others: motion, a focus that changes, or a board that bends.");
  if (std::abs(lens.camera.fx / lens.camera.fy - 1) > 0.02)
    advice.push_back(
        text_of("fx and fy differ by %.1f %%: few cameras do. Was the board printed with the same scale in "
                "both directions?",
                100 * std::abs(lens.camera.fx / lens.camera.fy - 1)));
}

}  // namespace

std::vector<std::string> calibration_advice(const LensCalibration& lens) {
  std::vector<std::string> advice;
  if (lens.deviations.size() == 0)
    advice.emplace_back("The views do not determine all parameters: take a simpler --model, or tilt the board more.");
  else if (lens.deviations[0] > kUnsureFocal * lens.camera.fx)
    advice.push_back(
        text_of("The focal length is known to %.2f %% only: more views, with the board larger in the image and "
                "tilted more.",
                100 * lens.deviations[0] / lens.camera.fx));
  if (!lens.sees_whole_image)
    advice.emplace_back(
        "The distortion folds over before the border of the image: choose another --model, or bring the "
        "board into the corners.");
  advise_fit(lens, advice);
  if (lens.views.size() < kEnoughViews)
    advice.push_back("Only " + std::to_string(lens.views.size()) + " views: 15 or more are better.");
  advise_coverage(lens, advice);
  advise_corners(lens, advice);
  advise_tilt(lens, advice);
  return advice;
}

}  // namespace ldso
