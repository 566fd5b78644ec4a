// Point selection: the three strategies as a keyframe calls them, and their kernels against the scalar references.

#include <benchmark/benchmark.h>

#include <vector>

#include "odometry/selection/point_selector.h"
#include "odometry/selection/selection_kernels.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

constexpr int kWanted = 1500;

// Strong texture, weak texture and none, like a real image: the contrast changes over the image.
const ImagePyramid& pyramid(int width, int height) {
  static ImagePyramid cached;
  if (cached.levels.empty() || cached.levels[0].width() != width || cached.levels[0].height() != height) {
    cached = selection_test::pyramid_of(selection_test::grey_image(width, height, [](int x, int y) {
      const double contrast = 400 * selection_test::smooth_noise(x, y, 90, 11) - 80;
      return 20 + selection_test::texture(x, y, contrast > 0 ? contrast : 0.0);
    }));
  }
  return cached;
}

void select_points(benchmark::State& state, SelectionStrategy strategy) {
  const ImagePyramid& frame = pyramid(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  SelectionSettings settings;
  settings.strategy = strategy;
  const auto selector = make_point_selector(settings);
  std::size_t selected = 0;
  for (auto _ : state) selected = selector->select(frame, 1, kWanted).size();
  state.counters["points"] = static_cast<double>(selected);
}

void frame_sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1242, 375})->Args({416, 128})->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(select_points, corners, SelectionStrategy::kCorners)->Apply(frame_sizes);
BENCHMARK_CAPTURE(select_points, gradient, SelectionStrategy::kGradient)->Apply(frame_sizes);
BENCHMARK_CAPTURE(select_points, random, SelectionStrategy::kRandom)->Apply(frame_sizes);

void select_on_level(benchmark::State& state) {
  const Image<Texel>& level = pyramid(640, 480).levels[state.range(0)];
  for (auto _ : state) benchmark::DoNotOptimize(select_gradient_pixels(level, kWanted, 1));
}
BENCHMARK(select_on_level)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

// The kernels, on all rows of a 640x480 image.
const Image<Texel>& kernel_level() { return pyramid(640, 480).levels[0]; }
const float* texel_row(const Image<Texel>& level, int y) { return reinterpret_cast<const float*>(level.row(y)); }

template <class Kernel>
void squared_gradients_of_image(benchmark::State& state, Kernel kernel) {
  const Image<Texel>& level = kernel_level();
  std::vector<float> squared(level.width());
  for (auto _ : state) {
    for (int y = 0; y < level.height(); ++y) kernel(texel_row(level, y), level.width(), squared.data());
    benchmark::DoNotOptimize(squared.data());
  }
}
BENCHMARK_CAPTURE(squared_gradients_of_image, simd, &squared_gradient_row)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(squared_gradients_of_image, scalar, &squared_gradient_row_reference)->Unit(benchmark::kMicrosecond);

template <class Kernel>
void tensor_of_image(benchmark::State& state, Kernel kernel) {
  const Image<Texel>& level = kernel_level();
  Image<float> out(level.width(), 3);
  for (auto _ : state) {
    for (int y = 0; y < level.height(); ++y) {
      kernel(texel_row(level, y), level.width(), TensorRow{out.row(0), out.row(1), out.row(2)});
    }
    benchmark::DoNotOptimize(out.data());
  }
}
BENCHMARK_CAPTURE(tensor_of_image, simd, &tensor_row)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tensor_of_image, scalar, &tensor_row_reference)->Unit(benchmark::kMicrosecond);

template <class Kernel>
void corner_scores_of_image(benchmark::State& state, Kernel kernel) {
  const Image<Texel>& level = kernel_level();
  const int width = level.width();
  Image<float> storage(width, 3 * (kTensorSide + 1));
  TensorRow rows[kTensorSide + 1];
  for (int r = 0; r <= kTensorSide; ++r) {
    rows[r] = {storage.row(3 * r), storage.row(3 * r + 1), storage.row(3 * r + 2)};
    tensor_row(texel_row(level, 100 + r), width, rows[r]);
  }
  const std::vector<float> usable(width, 1.0f);
  std::vector<float> scores(width);
  for (auto _ : state) {
    for (int y = 0; y < level.height(); ++y) kernel(rows, usable.data(), width, rows[kTensorSide], scores.data());
    benchmark::DoNotOptimize(scores.data());
  }
}
BENCHMARK_CAPTURE(corner_scores_of_image, simd, &corner_score_row)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(corner_scores_of_image, scalar, &corner_score_row_reference)->Unit(benchmark::kMicrosecond);

// Squared gradients and thresholds that about one pixel in ten exceeds.
struct SearchImage {
  SearchImage() : squared(kernel_level().width(), kernel_level().height()), thresholds(squared.width(), 150.0f) {
    for (int y = 0; y < squared.height(); ++y) {
      squared_gradient_row(texel_row(kernel_level(), y), squared.width(), squared.row(y));
    }
  }
  Image<float> squared;
  std::vector<float> thresholds;
};

template <class Kernel>
void find_above_in_image(benchmark::State& state, Kernel kernel) {
  const SearchImage image;
  const int width = image.squared.width();
  std::vector<std::int32_t> indices(width);
  int found = 0;
  for (auto _ : state) {
    found = 0;
    for (int y = 0; y < image.squared.height(); ++y) {
      found += kernel(image.squared.row(y), image.thresholds.data(), width, indices.data());
    }
    benchmark::DoNotOptimize(indices.data());
  }
  state.counters["found"] = found;
}
BENCHMARK_CAPTURE(find_above_in_image, simd, &find_above)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(find_above_in_image, scalar, &find_above_reference)->Unit(benchmark::kMicrosecond);

template <class Kernel>
void find_peaks_in_image(benchmark::State& state, Kernel kernel) {
  const SearchImage image;
  const int width = image.squared.width();
  std::vector<std::int32_t> indices(width);
  int found = 0;
  for (auto _ : state) {
    found = 0;
    for (int y = 1; y < image.squared.height() - 1; ++y) {
      const float* row = image.squared.row(y);
      found += kernel(row - width, row, row + width, width, 150.0f, indices.data());
    }
    benchmark::DoNotOptimize(indices.data());
  }
  state.counters["found"] = found;
}
BENCHMARK_CAPTURE(find_peaks_in_image, simd, &find_peaks)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(find_peaks_in_image, scalar, &find_peaks_reference)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ldso
