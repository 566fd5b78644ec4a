#include "mapping/matching/descriptor_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ldso {
namespace {

/// Beyond every Hamming distance of 256 bits.
constexpr int kNoDistance = 257;
/// A full turn [rad].
constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

/// The angle in -pi..pi; NaN stays NaN.
float wrapped(float angle) { return std::remainder(angle, kTwoPi); }

/// The nearest feature seen so far, and how near the second nearest is.
struct Nearest {
  int index = -1;
  int distance = kNoDistance;
  int second = kNoDistance;

  void offer(int candidate, int candidate_distance) {
    if (candidate_distance < distance) {
      second = distance;
      distance = candidate_distance;
      index = candidate;
    } else {
      second = std::min(second, candidate_distance);
    }
  }

  bool accepted(int max_distance, double max_ratio) const {
    if (index < 0 || distance > max_distance) return false;
    // Of equally near ones none is the nearest, also where the ratio test is off.
    return static_cast<float>(distance) < std::min(static_cast<float>(max_ratio), 1.0f) * static_cast<float>(second);
  }
};

/// Indices of the features, grouped by node in ascending order.
std::vector<int> order_by_node(std::span<const MapFeature> features) {
  std::vector<int> order(features.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int i, int j) { return features[i].node < features[j].node; };
  // Features of the map lie so already.
  if (!std::is_sorted(order.begin(), order.end(), before)) std::stable_sort(order.begin(), order.end(), before);
  return order;
}

struct NearestOfBoth {
  std::vector<Nearest> of_a, of_b;
};

void compare(std::span<const MapFeature> a, std::span<const MapFeature> b, std::span<const int> indices_a,
             std::span<const int> indices_b, NearestOfBoth& nearest) {
  for (const int i : indices_a) {
    for (const int j : indices_b) {
      const int distance = hamming_distance(a[i].feature.descriptor, b[j].feature.descriptor);
      nearest.of_a[i].offer(j, distance);
      nearest.of_b[j].offer(i, distance);
    }
  }
}

/// The range of `order`, from `begin` on, that has the node of its first element.
std::span<const int> group_at(std::span<const MapFeature> features, std::span<const int> order, std::size_t begin) {
  std::size_t end = begin;
  while (end < order.size() && features[order[end]].node == features[order[begin]].node) ++end;
  return order.subspan(begin, end - begin);
}

void compare_same_nodes(std::span<const MapFeature> a, std::span<const MapFeature> b, NearestOfBoth& nearest) {
  const std::vector<int> order_a = order_by_node(a), order_b = order_by_node(b);
  std::size_t i = 0, j = 0;
  while (i < order_a.size() && j < order_b.size()) {
    const std::span<const int> group_a = group_at(a, order_a, i), group_b = group_at(b, order_b, j);
    const std::uint32_t node_a = a[group_a.front()].node, node_b = b[group_b.front()].node;
    if (node_a == node_b) compare(a, b, group_a, group_b, nearest);
    if (node_a <= node_b) i += group_a.size();
    if (node_b <= node_a) j += group_b.size();
  }
}

void compare_all(std::span<const MapFeature> a, std::span<const MapFeature> b, NearestOfBoth& nearest) {
  std::vector<int> indices_a(a.size()), indices_b(b.size());
  std::iota(indices_a.begin(), indices_a.end(), 0);
  std::iota(indices_b.begin(), indices_b.end(), 0);
  compare(a, b, indices_a, indices_b, nearest);
}

/// The turn that most matches have: the fullest three neighbouring bins of a circular histogram, refined to the mean
/// direction of what lies in them. NaN if no turn is finite.
float common_turn(std::span<const float> turns) {
  // Of ten degrees each: orientations of the same corner differ by about as much.
  constexpr int kBins = 36;
  const auto bin_of = [](float turn) {
    const int bin = static_cast<int>(std::floor((turn + kTwoPi / 2) / kTwoPi * kBins));
    return std::clamp(bin, 0, kBins - 1);
  };
  std::array<int, kBins> counts{};
  for (const float turn : turns) {
    if (std::isfinite(turn)) ++counts[bin_of(turn)];
  }
  int best = 0, best_count = -1;
  for (int bin = 0; bin < kBins; ++bin) {
    const int count = counts[(bin + kBins - 1) % kBins] + 2 * counts[bin] + counts[(bin + 1) % kBins];
    if (count > best_count) best = bin, best_count = count;
  }
  const float centre = (static_cast<float>(best) + 0.5f) / kBins * kTwoPi - kTwoPi / 2;
  float sum = 0;
  int members = 0;
  for (const float turn : turns) {
    const float deviation = wrapped(turn - centre);
    if (std::abs(deviation) <= 1.5f * kTwoPi / kBins) sum += deviation, ++members;
  }
  return members > 0 ? centre + sum / static_cast<float>(members) : std::numeric_limits<float>::quiet_NaN();
}

/// The features of an image in square cells, for the question which are near a pixel.
class FeatureGrid {
 public:
  explicit FeatureGrid(std::span<const MapFeature> features) : features_(features), starts_(kSide * kSide + 1, 0) {
    // Counting sort: within a cell the features stay in ascending order.
    for (const MapFeature& f : features) {
      if (is_finite(f)) ++starts_[cell_of(f) + 1];
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    indices_.resize(starts_.back());
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (is_finite(features[i])) indices_[next[cell_of(features[i])]++] = static_cast<int>(i);
    }
  }

  /// Calls `visit(index)` for each feature at most `radius` from the pixel; all must be finite.
  template <class Visitor>
  void for_each_near(const Eigen::Vector2f& pixel, float radius, Visitor visit) const {
    for (int y = line_of(pixel.y() - radius); y <= line_of(pixel.y() + radius); ++y) {
      for (int x = line_of(pixel.x() - radius); x <= line_of(pixel.x() + radius); ++x) {
        for (int k = starts_[y * kSide + x]; k < starts_[y * kSide + x + 1]; ++k) {
          const Feature& f = features_[indices_[k]].feature;
          const float du = f.u - pixel.x(), dv = f.v - pixel.y();
          if (du * du + dv * dv <= radius * radius) visit(indices_[k]);
        }
      }
    }
  }

 private:
  /// Cells in each direction; what lies beyond the last one is filed in it.
  static constexpr int kSide = 64;
  /// Above the usual diameter of a search, which then touches four cells at most [px].
  static constexpr float kCellSize = 24;

  static bool is_finite(const MapFeature& f) { return std::isfinite(f.feature.u) && std::isfinite(f.feature.v); }
  static int line_of(float coordinate) {
    return static_cast<int>(std::clamp(coordinate / kCellSize, 0.0f, static_cast<float>(kSide - 1)));
  }
  static int cell_of(const MapFeature& f) { return line_of(f.feature.v) * kSide + line_of(f.feature.u); }

  std::span<const MapFeature> features_;
  std::vector<int> starts_;   ///< Of each cell in `indices_`.
  std::vector<int> indices_;  ///< Of the features, cell after cell.
};

Nearest nearest_to_prediction(const PredictedPoint& point, std::span<const MapFeature> features,
                              const FeatureGrid& grid, float max_turn) {
  Nearest nearest;
  if (!point.pixel.allFinite() || !std::isfinite(point.radius) || point.radius < 0) return nearest;
  grid.for_each_near(point.pixel, point.radius, [&](int index) {
    const Feature& feature = features[index].feature;
    if (std::abs(wrapped(feature.angle - point.angle)) > max_turn) return;  // never true of NaN
    nearest.offer(index, hamming_distance(point.descriptor, feature.descriptor));
  });
  return nearest;
}

}  // namespace

std::vector<FeatureMatch> match_descriptors(std::span<const MapFeature> a, std::span<const MapFeature> b,
                                            const LoopMatchingSettings& settings) {
  NearestOfBoth nearest{std::vector<Nearest>(a.size()), std::vector<Nearest>(b.size())};
  if (settings.guided) {
    compare_same_nodes(a, b, nearest);
  } else {
    compare_all(a, b, nearest);
  }
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < static_cast<int>(a.size()); ++i) {
    const Nearest& forth = nearest.of_a[i];
    if (!forth.accepted(settings.max_distance, settings.max_ratio)) continue;
    const Nearest& back = nearest.of_b[forth.index];
    if (back.index != i || !back.accepted(settings.max_distance, settings.max_ratio)) continue;
    matches.push_back({i, forth.index, forth.distance});
  }
  return settings.check_orientation ? keep_common_turn(matches, a, b, static_cast<float>(settings.max_turn)) : matches;
}

std::vector<FeatureMatch> match_by_projection(std::span<const PredictedPoint> points,
                                              std::span<const MapFeature> features,
                                              const LoopSearchSettings& settings) {
  const FeatureGrid grid(features);
  const auto max_turn = static_cast<float>(settings.max_turn);
  std::vector<FeatureMatch> wanted(points.size());
  std::vector<int> owner(features.size(), -1);  // the point that has the feature
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const Nearest nearest = nearest_to_prediction(points[i], features, grid, max_turn);
    if (!nearest.accepted(settings.max_distance, settings.max_ratio)) continue;
    wanted[i] = {i, nearest.index, nearest.distance};
    int& holder = owner[nearest.index];
    if (holder < 0 || nearest.distance < wanted[holder].distance) holder = i;
  }
  std::vector<FeatureMatch> matches;
  for (const FeatureMatch& match : wanted) {
    if (match.b >= 0 && owner[match.b] == match.a) matches.push_back(match);
  }
  return matches;
}

std::vector<bool> have_common_turn(std::span<const float> turns, float max_turn) {
  std::vector<float> all;
  all.reserve(turns.size());
  for (const float turn : turns) all.push_back(wrapped(turn));
  const float common = common_turn(all);
  std::vector<bool> have(turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) have[i] = std::abs(wrapped(all[i] - common)) <= max_turn;
  return have;
}

std::vector<FeatureMatch> keep_common_turn(std::span<const FeatureMatch> matches, std::span<const MapFeature> a,
                                           std::span<const MapFeature> b, float max_turn) {
  std::vector<float> turns;
  turns.reserve(matches.size());
  for (const FeatureMatch& m : matches) turns.push_back(b[m.b].feature.angle - a[m.a].feature.angle);
  const std::vector<bool> is_common = have_common_turn(turns, max_turn);
  std::vector<FeatureMatch> kept;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (is_common[i]) kept.push_back(matches[i]);
  }
  return kept;
}

}  // namespace ldso
