// What the odometry's inner loops cost: each kernel beside its scalar reference, and the stages built on them at the
// size of a full window (seven keyframes, 2000 points).

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "odometry/depth/epipolar_tracer.h"
#include "odometry/depth/search_kernels.h"
#include "odometry/residual/photometric_residual.h"
#include "odometry/residual/residual_kernels.h"
#include "odometry/test_synthetic_scene.h"
#include "odometry/tracking/alignment_kernels.h"
#include "odometry/tracking/coarse_depth_map.h"
#include "odometry/tracking/coarse_tracker.h"
#include "odometry/window/normal_equations.h"
#include "odometry/window/window_optimizer.h"

namespace ldso {
namespace {

constexpr int kKeyframes = 7;
constexpr int kPoints = 2000;

const test::SyntheticScene& scene() {
  static const test::SyntheticScene kScene(PinholeIntrinsics{640, 480, 440, 444, 319.1, 240.2});
  return kScene;
}

const std::vector<std::shared_ptr<const PreparedFrame>>& frames() {
  static const auto kFrames = test::render_path(scene(), kKeyframes);
  return kFrames;
}

/// All keyframes host about as many of the points.
Window full_window() {
  Window window = test::true_window(scene(), frames(), 30);
  for (auto& keyframe : window.keyframes) {
    auto& points = keyframe->points;
    points.resize(std::min<std::size_t>(points.size(), kPoints / kKeyframes));
  }
  window.camera_prior.setConstant(2e6);
  return window;
}

int count_points(const Window& window) {
  std::size_t count = 0;
  for (const auto& keyframe : window.keyframes) count += keyframe->points.size();
  return static_cast<int>(count);
}

/// The window at its linearization, with all that the stages need.
struct LinearizedWindow {
  ThreadPool pool{1};
  Window window = full_window();
  FramePairs pairs{window};
  std::vector<PointChunk> chunks = chunk_points(window, [](const ActivePoint&) { return true; });
  std::vector<PatternJob> jobs;

  LinearizedWindow() {
    linearize(window, pairs, chunks, window.front, pool);
    for (const PointChunk& chunk : chunks) {
      for (const ActivePoint* point : chunk.points) {
        for (const PointResidual& residual : point->residuals) {
          jobs.push_back(
              {&point->patch, &pairs(chunk.host, residual.target->index).warp, point->u, point->v, point->idepth});
        }
      }
    }
  }
};

template <auto kKernel>
void evaluate(benchmark::State& state) {
  const LinearizedWindow linearized;
  const auto count = static_cast<int>(linearized.jobs.size());
  std::vector<PatternSums> sums(linearized.jobs.size());
  for (auto _ : state) {
    kKernel(linearized.jobs.data(), sums.data(), count);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(evaluate<&evaluate_patterns>)->Name("evaluate_patterns/simd")->Unit(benchmark::kMicrosecond);
BENCHMARK(evaluate<&evaluate_patterns_reference>)->Name("evaluate_patterns/scalar")->Unit(benchmark::kMicrosecond);

template <auto kKernel>
void align(benchmark::State& state) {
  const AlignmentPoints points = make_coarse_depth_map(full_window()).levels.front();
  const PinholeIntrinsics& c = scene().camera();
  const Image<Texel>& image = frames().back()->pyramid.levels.front();
  AlignmentWarp warp;
  warp.texels = image.data();
  warp.width = c.width, warp.height = c.height;
  warp.fx = static_cast<float>(c.fx), warp.fy = static_cast<float>(c.fy);
  warp.cx = static_cast<float>(c.cx), warp.cy = static_cast<float>(c.cy);
  const float Ki[9] = {1 / warp.fx, 0, -warp.cx / warp.fx, 0, 1 / warp.fy, -warp.cy / warp.fy, 0, 0, 1};
  std::copy(Ki, Ki + 9, warp.RKi);
  warp.t[0] = 0.01f;
  for (auto _ : state) benchmark::DoNotOptimize(kKernel(points, 0, points.size(), warp));
  state.SetItemsProcessed(state.iterations() * points.size());
}
BENCHMARK(align<&align_points>)->Name("align_points/simd")->Unit(benchmark::kMicrosecond);
BENCHMARK(align<&align_points_reference>)->Name("align_points/scalar")->Unit(benchmark::kMicrosecond);

template <auto kKernel>
void search(benchmark::State& state) {
  const Image<Texel>& image = frames().front()->pyramid.levels.front();
  PatternSearch pattern;
  pattern.texels = image.data();
  pattern.width = image.width();
  for (int i = 0; i < kPatternSize; ++i) {
    pattern.offset_x[i] = static_cast<float>(kPattern[i].dx);
    pattern.offset_y[i] = static_cast<float>(kPattern[i].dy);
    pattern.intensity[i] = 128;
  }
  pattern.x = 300.3f, pattern.y = 200.7f, pattern.step_x = 0.8f, pattern.step_y = 0.6f;
  constexpr int kPositions = 30;
  std::array<float, kPositions> energies;
  for (auto _ : state) {
    kKernel(pattern, kPositions, energies.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kPositions);
}
BENCHMARK(search<&search_energies>)->Name("search_energies/simd");
BENCHMARK(search<&search_energies_reference>)->Name("search_energies/scalar");

void frame_pairs(benchmark::State& state) {
  const Window window = full_window();
  for (auto _ : state) benchmark::DoNotOptimize(FramePairs(window));
}
BENCHMARK(frame_pairs)->Unit(benchmark::kMicrosecond);

void linearize_window(benchmark::State& state) {
  LinearizedWindow l;
  for (auto _ : state) benchmark::DoNotOptimize(linearize(l.window, l.pairs, l.chunks, 1 - l.window.front, l.pool));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(l.jobs.size()));
}
BENCHMARK(linearize_window)->Unit(benchmark::kMicrosecond);

void build_normal_equations(benchmark::State& state) {
  LinearizedWindow l;
  NormalEquationsBuilder builder(l.pool);
  for (auto _ : state) benchmark::DoNotOptimize(builder.build(l.window, l.pairs, l.chunks, 0.1));
  state.counters["points"] = count_points(l.window);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(l.jobs.size()));
}
BENCHMARK(build_normal_equations)->Unit(benchmark::kMicrosecond);

void back_substitute(benchmark::State& state) {
  LinearizedWindow l;
  NormalEquationsBuilder builder(l.pool);
  builder.build(l.window, l.pairs, l.chunks, 0.1);
  const Eigen::VectorXd step = Eigen::VectorXd::Constant(l.window.dim(), 1e-6);
  for (auto _ : state) {
    builder.back_substitute(l.chunks, step);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(back_substitute)->Unit(benchmark::kMicrosecond);

/// Six iterations from a disturbed state; making the window is not timed.
void optimize_window(benchmark::State& state) {
  ThreadPool pool(static_cast<int>(state.range(0)));
  WindowOptimizer optimizer(pool);
  for (auto _ : state) {
    state.PauseTiming();
    Window window = full_window();
    test::disturb(window, 0.004, 0.002, 0.01, 1, 0.02, 3);
    state.ResumeTiming();
    benchmark::DoNotOptimize(optimizer.optimize(window, 6));
  }
}
BENCHMARK(optimize_window)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void depth_map(benchmark::State& state) {
  const Window window = full_window();
  for (auto _ : state) benchmark::DoNotOptimize(make_coarse_depth_map(window));
}
BENCHMARK(depth_map)->Unit(benchmark::kMicrosecond);

/// One frame from the pose of the frame before.
void track_frame(benchmark::State& state) {
  ThreadPool pool(static_cast<int>(state.range(0)));
  CoarseTracker tracker({}, pool);
  tracker.set_reference(full_window());
  const SE3d T_new_ref = test::path_pose(kKeyframes - 0.7) * test::path_pose(kKeyframes - 1).inverse();
  const auto frame = scene().render(kKeyframes, T_new_ref * test::path_pose(kKeyframes - 1));
  for (auto _ : state) benchmark::DoNotOptimize(tracker.align(*frame, SE3d(), {}, {}, {}));
}
BENCHMARK(track_frame)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime();

/// First searches: the whole segment.
void trace_points(benchmark::State& state) {
  const SE3d T_target_host = test::path_pose(0.5);
  const auto target = scene().render(1, T_target_host);
  const PinholeIntrinsics& c = scene().camera();
  const PatternWarp warp = make_warp(T_target_host, {c.fx, c.fy, c.cx, c.cy}, {}, target->pyramid.levels.front());
  std::vector<ImmaturePoint> points;
  for (int v = 40; v < 440; v += 12) {
    for (int u = 40; u < 600; u += 12) {
      ImmaturePoint point;
      make_immature_point(frames().front()->pyramid.levels.front(), static_cast<float>(u), static_cast<float>(v),
                          point);
      points.push_back(point);
    }
  }
  const EpipolarTracer tracer({}, c.width, c.height);
  for (auto _ : state) {
    for (const ImmaturePoint& point : points) {
      ImmaturePoint traced = point;
      benchmark::DoNotOptimize(tracer.trace(traced, warp));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(trace_points)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ldso
