#include "calibration/photometric/vignette.h"

#include <algorithm>
#include <cmath>

#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::size_t kLeastPlaneViews = 10;
constexpr int kKnots = 48;           // of the vignette along the longer side
constexpr double kLeastWeight = 20;  // samples, for a knot that is seen
constexpr double kLeastSeen = 0.5;   // of all knots
constexpr int kTurns = 30;
/// Samples that are off by so many times the usual do not count: edges, shadows, people.
constexpr double kStrayTimes = 3;
constexpr int kTurnsWithStrays = 8;

/// The vignette as values at knots, linear between them.
struct KnotImage {
  KnotImage(int width, int height)
      : spacing(static_cast<double>(std::max(width, height)) / kKnots),
        columns(static_cast<int>(std::ceil(width / spacing)) + 1),
        rows(static_cast<int>(std::ceil(height / spacing)) + 1),
        values(static_cast<std::size_t>(columns) * rows, 1.0) {}

  struct Corner {
    std::size_t index = 0;
    double weight = 0;
  };
  std::array<Corner, 4> corners(double x, double y) const {
    const double u = (x + 0.5) / spacing, v = (y + 0.5) / spacing;
    const int column = std::clamp(static_cast<int>(u), 0, columns - 2);
    const int row = std::clamp(static_cast<int>(v), 0, rows - 2);
    const double a = u - column, b = v - row;
    const auto first = static_cast<std::size_t>(row * columns + column);
    const auto below = first + static_cast<std::size_t>(columns);
    return {{{first, (1 - a) * (1 - b)}, {first + 1, a * (1 - b)}, {below, (1 - a) * b}, {below + 1, a * b}}};
  }

  double at(double x, double y) const {
    double sum = 0;
    for (const Corner& corner : corners(x, y)) sum += corner.weight * values[corner.index];
    return sum;
  }

  double spacing;  ///< [px]
  int columns, rows;
  std::vector<double> values;
};

/// All unknowns.
struct Unknowns {
  KnotImage vignette;
  std::vector<double> plane;      ///< Irradiance of each cell for an exposure of one.
  std::vector<double> exposures;  ///< Of each view.
};

double explained(const Unknowns& u, std::size_t view, const PlaneView::Sample& s) {
  return u.exposures[view] * u.plane[static_cast<std::size_t>(s.cell)] * u.vignette.at(s.pixel.x(), s.pixel.y());
}

/// Ratios of two sums, one for each unknown: weighted least squares of one factor while the others are held.
struct Ratios {
  explicit Ratios(std::size_t count) : up(count), down(count) {}
  void add(std::size_t i, double factor, double value, double weight = 1) {
    up[i] += weight * factor * value;
    down[i] += weight * factor * factor;
  }
  std::vector<double> up, down;
};

/// Calls `use(view, sample)` for samples that do not stray.
template <class Use>
void each_sample(const std::vector<PlaneView>& views, const Unknowns& u, double most, const Use& use) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const PlaneView::Sample& s : views[i].samples) {
      if (std::abs(s.irradiance - explained(u, i, s)) <= most) use(i, s);
    }
  }
}

void fit_plane(const std::vector<PlaneView>& views, double most, Unknowns& u) {
  Ratios ratios(u.plane.size());
  each_sample(views, u, most, [&](std::size_t i, const PlaneView::Sample& s) {
    ratios.add(static_cast<std::size_t>(s.cell), u.exposures[i] * u.vignette.at(s.pixel.x(), s.pixel.y()),
               s.irradiance);
  });
  for (std::size_t i = 0; i < u.plane.size(); ++i) u.plane[i] = ratios.down[i] > 0 ? ratios.up[i] / ratios.down[i] : 0;
}

void fit_exposures(const std::vector<PlaneView>& views, double most, Unknowns& u) {
  Ratios ratios(views.size());
  each_sample(views, u, most, [&](std::size_t i, const PlaneView::Sample& s) {
    ratios.add(i, explained(u, i, s) / u.exposures[i], s.irradiance);
  });
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (ratios.down[i] > 0) u.exposures[i] = ratios.up[i] / ratios.down[i];
  }
}

/// Unseen knots become the mean of those around them, from the seen ones outwards.
void continue_unseen(std::vector<bool> seen, KnotImage& image) {
  for (bool any = true; any;) {
    any = false;
    const std::vector<bool> before = seen;
    for (int i = 0; i < image.columns * image.rows; ++i) {
      if (before[static_cast<std::size_t>(i)]) continue;
      double sum = 0;
      int count = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = i % image.columns + dx, y = i / image.columns + dy;
          if (x < 0 || y < 0 || x >= image.columns || y >= image.rows) continue;
          const auto k = static_cast<std::size_t>(y * image.columns + x);
          if (!before[k]) continue;
          sum += image.values[k];
          ++count;
        }
      }
      if (count == 0) continue;
      image.values[static_cast<std::size_t>(i)] = sum / count;
      seen[static_cast<std::size_t>(i)] = true;
      any = true;
    }
  }
}

/// Returns the share of knots that were seen.
double fit_vignette(const std::vector<PlaneView>& views, double most, Unknowns& u) {
  KnotImage& image = u.vignette;
  Ratios ratios(image.values.size());
  std::vector<double> weights(image.values.size());
  each_sample(views, u, most, [&](std::size_t i, const PlaneView::Sample& s) {
    const double factor = u.exposures[i] * u.plane[static_cast<std::size_t>(s.cell)];
    // What the knots explain already is added: the step is the residual's, spread over the four.
    const double now = image.at(s.pixel.x(), s.pixel.y());
    for (const KnotImage::Corner& corner : image.corners(s.pixel.x(), s.pixel.y())) {
      const double value = s.irradiance + factor * (image.values[corner.index] - now);
      ratios.add(corner.index, factor, value, corner.weight);
      weights[corner.index] += corner.weight;
    }
  });
  std::vector<bool> seen(image.values.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen[i] = weights[i] >= kLeastWeight && ratios.down[i] > 0;
    if (seen[i]) image.values[i] = ratios.up[i] / ratios.down[i];
  }
  continue_unseen(seen, image);
  const double largest = *std::max_element(image.values.begin(), image.values.end());
  for (double& value : image.values) value = std::max(value / largest, 1e-3);
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / static_cast<double>(seen.size());
}

double usual_error(const std::vector<PlaneView>& views, const Unknowns& u, double most) {
  double sum = 0, count = 0;
  each_sample(views, u, most, [&](std::size_t i, const PlaneView::Sample& s) {
    sum += std::pow(s.irradiance - explained(u, i, s), 2);
    ++count;
  });
  return std::sqrt(sum / std::max(1.0, count));
}

double mean_irradiance(const std::vector<PlaneView>& views) {
  double sum = 0, count = 0;
  for (const PlaneView& view : views) {
    for (const PlaneView::Sample& s : view.samples) sum += s.irradiance;
    count += static_cast<double>(view.samples.size());
  }
  return sum / std::max(1.0, count);
}

Unknowns first_guess(const std::vector<PlaneView>& views, int plane_cells, int width, int height, bool known) {
  Unknowns u{KnotImage(width, height), std::vector<double>(static_cast<std::size_t>(plane_cells)), {}};
  for (const PlaneView& view : views) u.exposures.push_back(known ? *view.exposure_ms : 1);
  return u;
}

}  // namespace

VignetteEstimate estimate_vignette(const std::vector<PlaneView>& views, int plane_cells, int width, int height,
                                   const std::string& where) {
  if (views.size() < kLeastPlaneViews)
    throw Error(where,
                "the board is found in " + std::to_string(views.size()) + " images, which do not tell the vignette",
                "film the board on an evenly coloured, dull wall, for 30 seconds, from all sides");
  VignetteEstimate result;
  result.exposures_known =
      std::all_of(views.begin(), views.end(), [](const PlaneView& view) { return view.exposure_ms.value_or(0) > 0; });
  Unknowns u = first_guess(views, plane_cells, width, height, result.exposures_known);
  double most = INFINITY;
  for (int turn = 0; turn < kTurns; ++turn) {
    fit_plane(views, most, u);
    if (!result.exposures_known) fit_exposures(views, most, u);
    result.seen_share = fit_vignette(views, most, u);
    if (turn + 1 >= kTurnsWithStrays) {
      fit_plane(views, INFINITY, u);  // The scale of the vignette has changed.
      most = kStrayTimes * usual_error(views, u, most);
    }
  }
  if (result.seen_share < kLeastSeen)
    throw Error(where,
                "the plane around the board is seen in " + std::to_string(std::lround(100 * result.seen_share)) +
                    " % of the image only",
                "bring the board near and far and into all corners of the image");
  result.rms = usual_error(views, u, most) / mean_irradiance(views);
  result.vignette = Image<float>(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) result.vignette(x, y) = static_cast<float>(u.vignette.at(x, y));
  }
  return result;
}

}  // namespace ldso
