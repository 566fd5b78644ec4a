#include "experiment/summary/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "util/format_text.h"

namespace ldso {
namespace {

/// Every eighth of the scale; between them straight lines are within 2 of 255 of the original.
constexpr std::array<std::array<double, 3>, 9> kViridis = {{{68, 1, 84},
                                                            {71, 44, 122},
                                                            {59, 81, 139},
                                                            {44, 113, 142},
                                                            {33, 144, 141},
                                                            {39, 173, 129},
                                                            {92, 200, 99},
                                                            {170, 220, 50},
                                                            {253, 231, 37}}};
constexpr double kMostDecades = 3;

/// The next of 1, 2, 5 times a power of ten at or below (above) a positive value.
double round_outwards(double value, bool up) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  double below = power;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    const double step = factor * power;
    if (up && step >= value * (1 - 1e-9)) return step;
    if (step <= value * (1 + 1e-9)) below = step;
  }
  return below;
}

}  // namespace

std::string viridis(double value) {
  const double at = std::clamp(value, 0.0, 1.0) * static_cast<double>(kViridis.size() - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double t = at - static_cast<double>(left);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<int>(std::lround((1 - t) * kViridis[left][c] + t * kViridis[left + 1][c]));
  }
  return format_text("#%02x%02x%02x", rgb[0] & 0xff, rgb[1] & 0xff, rgb[2] & 0xff);
}

ErrorColours::ErrorColours(std::vector<double> errors) {
  std::erase_if(errors, [](double error) { return !std::isfinite(error) || error <= 0; });
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const std::size_t outer = errors.size() / 100;
  high_ = round_outwards(errors[errors.size() - 1 - outer], true);
  low_ = round_outwards(std::max(errors[outer], high_ * std::pow(10.0, -kMostDecades)), false);
  if (low_ >= high_) high_ = 10 * low_;
}

std::string ErrorColours::colour(double error) const {
  if (!(error > 0)) return viridis(0);
  return viridis((std::log10(error) - std::log10(low_)) / (std::log10(high_) - std::log10(low_)));
}

std::string ErrorColours::legend(const SvgBox& box, const std::string& label) const {
  constexpr int kSteps = 64;
  constexpr double kTextSize = 12;
  std::string svg;
  for (int i = 0; i < kSteps; ++i) {
    // Each step reaches a little under the next, so that no seam shows.
    const double top = box.y + box.height * (kSteps - 1 - i) / kSteps;
    svg += format_text("<rect x=\"%.1f\" y=\"%.2f\" width=\"%.1f\" height=\"%.2f\" fill=\"%s\"/>\n", box.x, top,
                       box.width, box.height / kSteps + (i > 0 ? 0.6 : 0.0), viridis((i + 0.5) / kSteps).c_str());
  }
  const Range exponents{std::log10(low_), std::log10(high_)};
  for (const Tick& tick : log_ticks(exponents)) {
    const double y = box.y + box.height * (exponents.max - tick.position) / exponents.length();
    svg += format_text("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#222222\"/>\n",
                       box.x + box.width, y, box.x + box.width + 5, y);
    svg += svg_text(box.x + box.width + 9, y + 4, tick.label, kTextSize);
  }
  return svg + svg_text(box.x, box.y - 10, label, kTextSize + 1, "start", "font-weight=\"bold\"");
}

}  // namespace ldso
