#include "odometry/selection/corner_detector.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "odometry/selection/selection_kernels.h"

namespace ldso {
namespace {

// Below this score a window of 5x5 pixels holds nothing but noise of about a grey level.
constexpr float kLeastScore = 1.0f;

// Least ratio of the eigenvalues: the steps of a straight, strong edge on the pixel grid exceed the fraction of the
// best score too, but slide along the edge from frame to frame (the test of Lowe, IJCV 2004, section 4.1, r = 10).
constexpr float kLeastEigenvalueRatio = 0.1f;

struct ScoreMap {
  Image<float> scores;
  float best = 0;
};

// Rows of the structure tensor that the sliding window of the score looks at.
class TensorRing {
 public:
  TensorRing(const Image<Texel>& level) : level_(level), storage_(level.width(), 3 * (kTensorSide + 1)) {
    for (int y = 0; y < std::min(kTensorSide - 1, level.height()); ++y) fill(y);
  }

  void fill(int y) { tensor_row(reinterpret_cast<const float*>(level_.row(y)), level_.width(), slot(y % kTensorSide)); }

  /// Rows y - kTensorRadius to y + kTensorRadius; the last one is computed here.
  void window(int y, TensorRow (&rows)[kTensorSide]) {
    fill(y + kTensorRadius);
    for (int i = 0; i < kTensorSide; ++i) rows[i] = slot((y - kTensorRadius + i) % kTensorSide);
  }

  TensorRow scratch() { return slot(kTensorSide); }

 private:
  TensorRow slot(int i) { return {storage_.row(3 * i), storage_.row(3 * i + 1), storage_.row(3 * i + 2)}; }

  const Image<Texel>& level_;
  Image<float> storage_;
};

ScoreMap corner_scores(const Image<Texel>& level, const Image<float>& usable) {
  ScoreMap map{Image<float>(level.width(), level.height()), 0};
  TensorRing ring(level);
  TensorRow rows[kTensorSide];
  for (int y = kTensorRadius; y < level.height() - kTensorRadius; ++y) {
    ring.window(y, rows);
    const float best = corner_score_row(rows, usable.row(y), level.width(), ring.scratch(), map.scores.row(y));
    map.best = std::max(map.best, best);
  }
  return map;
}

struct Offset {
  int dx, dy;
};

// The disc without its centre, nearest first: most pixels fail at a direct neighbour.
std::vector<Offset> disc(int radius) {
  std::vector<Offset> offsets;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const int square = dx * dx + dy * dy;
      if (square > 0 && square <= radius * radius) offsets.push_back({dx, dy});
    }
  }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](Offset a, Offset b) { return a.dx * a.dx + a.dy * a.dy < b.dx * b.dx + b.dy * b.dy; });
  return offsets;
}

// Of equal scores the first in raster order wins.
bool is_maximum(const Image<float>& scores, int x, int y, const std::vector<Offset>& neighbourhood) {
  const float score = scores(x, y);
  for (const Offset offset : neighbourhood) {
    const int nx = x + offset.dx, ny = y + offset.dy;
    if (nx < 0 || ny < 0 || nx >= scores.width() || ny >= scores.height()) continue;
    const bool before = offset.dy < 0 || (offset.dy == 0 && offset.dx < 0);
    if (before ? scores(nx, ny) >= score : scores(nx, ny) > score) return false;
  }
  return true;
}

bool is_on_edge(const Image<Texel>& level, int x, int y, float smaller_eigenvalue) {
  float trace = 0;
  for (int dy = -kTensorRadius; dy <= kTensorRadius; ++dy) {
    for (int dx = -kTensorRadius; dx <= kTensorRadius; ++dx) {
      const Texel& texel = level(x + dx, y + dy);
      trace += texel.dx * texel.dx + texel.dy * texel.dy;
    }
  }
  const float greater_eigenvalue = trace / (kTensorSide * kTensorSide) - smaller_eigenvalue;
  return smaller_eigenvalue < kLeastEigenvalueRatio * greater_eigenvalue;
}

bool stronger(const Corner& a, const Corner& b) {
  return std::tuple(-a.score, a.y, a.x) < std::tuple(-b.score, b.y, b.x);
}

}  // namespace

std::vector<Corner> detect_corners(const Image<Texel>& level, const Image<float>& usable, double quality, int radius) {
  const ScoreMap map = corner_scores(level, usable);
  const float threshold = std::max(static_cast<float>(quality) * map.best, kLeastScore);
  const std::vector<Offset> neighbourhood = disc(radius);
  std::vector<std::int32_t> peaks(level.width());
  std::vector<Corner> corners;
  for (int y = 1; y < level.height() - 1; ++y) {
    const float* row = map.scores.row(y);
    const int found =
        find_peaks(map.scores.row(y - 1), row, map.scores.row(y + 1), level.width(), threshold, peaks.data());
    for (int i = 0; i < found; ++i) {
      const Corner corner{peaks[i], y, row[peaks[i]]};
      if (!is_maximum(map.scores, corner.x, y, neighbourhood)) continue;
      if (!is_on_edge(level, corner.x, y, corner.score)) corners.push_back(corner);
    }
  }
  return corners;
}

std::vector<Corner> spread_corners(std::vector<Corner> corners, int cell_side, int wanted) {
  std::sort(corners.begin(), corners.end(), stronger);
  int columns = 0, rows = 0;
  for (const Corner& corner : corners) {
    columns = std::max(columns, corner.x / cell_side + 1);
    rows = std::max(rows, corner.y / cell_side + 1);
  }
  Image<int> corners_in_cell(columns, rows, 0);
  std::vector<std::pair<int, Corner>> ranked;
  for (const Corner& corner : corners) {
    ranked.push_back({corners_in_cell(corner.x / cell_side, corner.y / cell_side)++, corner});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  corners.clear();
  for (std::size_t i = 0; i < ranked.size() && static_cast<int>(i) < wanted; ++i) corners.push_back(ranked[i].second);
  return corners;
}

}  // namespace ldso
