// The pose graph of a long drive in laps: all loops at once, and one more loop after the others.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>

#include "mapping/graph/pose_graph.h"
#include "mapping/graph/test_pose_graph_scene.h"

namespace ldso {
namespace {

constexpr int kKeyframes = 5000, kLoops = 200;

PoseGraphSceneSettings long_drive() {
  PoseGraphSceneSettings settings;
  settings.keyframes = kKeyframes;
  settings.keyframes_per_lap = 1000;
  settings.radius = 150;
  settings.translation = 0.02;
  settings.rotation = 0.0005;
  settings.log_scale = 0.001;
  return settings;
}

/// Loops with the laps before, spread over all laps but the first; `wrong` of them are 20 m off.
PoseGraph make_graph(PoseGraphScene& scene, int loops, int wrong) {
  PoseGraph graph;
  scene.add_odometry(graph);
  const int lap = scene.settings.keyframes_per_lap;
  for (int i = 0; i < loops; ++i) {
    const int to = lap + (kKeyframes - lap) * (i + 1) / (kLoops + 1);
    const int from = to - lap * (1 + i % (to / lap));
    const bool is_wrong = wrong > 0 && i % (loops / wrong) == loops / wrong / 2;
    graph.add_loop_edge(is_wrong ? scene.wrong_loop(from + 20, to) : scene.true_loop(from, to));
  }
  return graph;
}

/// Times the optimization from `start` and reports what came of it.
void time_optimization(benchmark::State& state, const PoseGraphScene& scene, const PoseGraph& start) {
  PoseGraph graph = start;
  PoseGraphReport report;
  for (auto _ : state) {
    state.PauseTiming();
    graph = start;
    state.ResumeTiming();
    report = graph.optimize(kKeyframes - 1);
  }
  if (!report.ok || !report.converged) state.SkipWithError(report.reason.c_str());
  state.counters["iterations"] = report.iterations;
  state.counters["cost"] = report.final_cost;
  state.counters["rmse"] = scene.error(graph);
}

/// All 200 loops are new; the argument is how many of them are wrong.
void all_loops_at_once(benchmark::State& state) {
  PoseGraphScene scene(long_drive());
  const PoseGraph start = make_graph(scene, kLoops, static_cast<int>(state.range(0)));
  time_optimization(state, scene, start);
}
BENCHMARK(all_loops_at_once)->Arg(0)->Arg(10)->Unit(benchmark::kMillisecond);

/// The others are closed already. The argument is how many of all are wrong.
void one_more_loop(benchmark::State& state) {
  PoseGraphScene scene(long_drive());
  PoseGraph start = make_graph(scene, kLoops - 1, static_cast<int>(state.range(0)));
  start.optimize(kKeyframes - 1);
  start.add_loop_edge(scene.true_loop(300, kKeyframes - 700 + 1));
  time_optimization(state, scene, start);
}
BENCHMARK(one_more_loop)->Arg(0)->Arg(10)->Unit(benchmark::kMillisecond);

/// The others are closed already, and this one claims that two places are one which lie as many keyframes (about
/// metres) apart as the argument says: on the next street, or on the other side of the lap.
void one_wrong_loop(benchmark::State& state) {
  PoseGraphScene scene(long_drive());
  PoseGraph start = make_graph(scene, kLoops - 1, 0);
  start.optimize(kKeyframes - 1);
  start.add_loop_edge(scene.wrong_loop(kKeyframes - 1700 - state.range(0), kKeyframes - 700));
  time_optimization(state, scene, start);
}
BENCHMARK(one_wrong_loop)->Arg(20)->Arg(300)->Unit(benchmark::kMillisecond);

/// What the odometry adds while it runs.
void build(benchmark::State& state) {
  PoseGraphScene scene(long_drive());
  for (auto _ : state) benchmark::DoNotOptimize(make_graph(scene, kLoops, 0));
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ldso
