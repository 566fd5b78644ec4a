#include "odometry/selection/gradient_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "odometry/selection/selection_kernels.h"

namespace ldso {
namespace {

struct Run {
  int y, begin, end;
};

void append_unusable_runs(const float* row, int width, int y, std::vector<Run>* runs) {
  for (int x = 0; x < width; ++x) {
    if (row[x] >= 0) continue;
    const int begin = x;
    while (x < width && row[x] < 0) ++x;
    runs->push_back({y, begin, x});
  }
}

void mark_unusable(Image<float>* map, int y, int begin, int end) {
  std::fill(map->row(y) + begin, map->row(y) + end, kUnusable);
}

void mark_around(const std::vector<Run>& runs, int clearance, Image<float>* map) {
  for (const Run& run : runs) {
    const int begin = std::max(run.begin - clearance, 0);
    const int end = std::min(run.end + clearance, map->width());
    const int last = std::min(run.y + clearance, map->height() - 1);
    for (int y = std::max(run.y - clearance, 0); y <= last; ++y) mark_unusable(map, y, begin, end);
  }
}

void mark_margin(int margin, Image<float>* map) {
  const int width = map->width(), height = map->height();
  const int side = std::min(margin, width);
  for (int y = 0; y < height; ++y) {
    const bool outer_row = y < margin || y >= height - margin;
    mark_unusable(map, y, 0, outer_row ? width : side);
    mark_unusable(map, y, width - side, width);
  }
}

// Half a grey level a bin is finer than the noise.
constexpr float kBinsPerGreyLevel = 2;
// Up to 64 grey levels a pixel: steeper medians do not occur.
constexpr int kBins = 128;
// Every other pixel of every other row is plenty for a median of 32x32.
constexpr int kStep = 2;

class MedianHistogram {
 public:
  void add(float squared_gradient) {
    if (squared_gradient < 0) return;
    const int bin = static_cast<int>(std::sqrt(squared_gradient) * kBinsPerGreyLevel);
    ++counts_[std::min(bin, kBins - 1)];
    ++total_;
  }

  bool empty() const { return total_ == 0; }

  float median() const {
    int bin = 0;
    for (int below = counts_[0]; 2 * below < total_; below += counts_[bin]) ++bin;
    return (static_cast<float>(bin) + 0.5f) / kBinsPerGreyLevel;
  }

 private:
  std::array<int, kBins> counts_{};
  int total_ = 0;
};

float block_median(const Image<float>& map, int x_begin, int y_begin, int size) {
  MedianHistogram histogram;
  const int x_end = std::min(x_begin + size, map.width());
  const int y_end = std::min(y_begin + size, map.height());
  for (int y = y_begin; y < y_end; y += kStep) {
    const float* row = map.row(y);
    for (int x = x_begin; x < x_end; x += kStep) histogram.add(row[x]);
  }
  return histogram.empty() ? kUnusable : histogram.median();
}

float mean_of_neighbours(const Image<float>& medians, int bx, int by) {
  float sum = 0;
  int count = 0;
  for (int y = std::max(by - 1, 0); y <= std::min(by + 1, medians.height() - 1); ++y) {
    for (int x = std::max(bx - 1, 0); x <= std::min(bx + 1, medians.width() - 1); ++x) {
      if (medians(x, y) < 0) continue;
      sum += medians(x, y);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<float>(count) : 0.0f;
}

}  // namespace

Image<float> squared_gradients(const Image<Texel>& level, int margin, int clearance) {
  Image<float> map(level.width(), level.height());
  std::vector<Run> invalid;
  for (int y = 0; y < level.height(); ++y) {
    const float* texels = reinterpret_cast<const float*>(level.row(y));
    if (!squared_gradient_row(texels, level.width(), map.row(y))) {
      append_unusable_runs(map.row(y), level.width(), y, &invalid);
    }
  }
  mark_around(invalid, clearance, &map);
  mark_margin(margin, &map);
  return map;
}

Image<float> block_medians(const Image<float>& squared_gradients, int block_size) {
  const int columns = (squared_gradients.width() + block_size - 1) / block_size;
  const int rows = (squared_gradients.height() + block_size - 1) / block_size;
  Image<float> raw(columns, rows);
  for (int by = 0; by < rows; ++by) {
    for (int bx = 0; bx < columns; ++bx) {
      raw(bx, by) = block_median(squared_gradients, bx * block_size, by * block_size, block_size);
    }
  }
  Image<float> smooth(columns, rows);
  for (int by = 0; by < rows; ++by) {
    for (int bx = 0; bx < columns; ++bx) smooth(bx, by) = mean_of_neighbours(raw, bx, by);
  }
  return smooth;
}

}  // namespace ldso
