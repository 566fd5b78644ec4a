// Are the standard deviations of the map's inverse depths true? Renders sequences, runs on them, and compares each
// point with the exact depth, after the unit of each keyframe is taken out.
//
//   depth_truth [WORLD...] [--help lists the options]
//
// The squared error in standard deviations has the median 0.45 and the mean 1 if it is Gaussian and the deviations are
// right.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "ldso/error.h"
#include "simulation/sequences/sequence_recipe.h"
#include "tests/depth_errors.h"

namespace ldso {
namespace {

/// What is farther off than so many standard deviations is an outlier, a point on an edge in depth for instance.
constexpr double kInlier = 4;

void print(const std::string& name, const test::DepthErrors& errors) {
  std::printf("%-10s %9d %8zu %10.4f %10.3f %10.3f %9.1f %%\n", name.c_str(), errors.keyframes, errors.squared.size(),
              errors.median_relative(), errors.median_squared(), errors.mean_squared_of_inliers(kInlier),
              100 * (1 - errors.inlier_share(kInlier)));
}

int run(int argc, char** argv) {
  CLI::App app{"Errors of the map's inverse depths in their standard deviations"};
  std::vector<std::string> worlds{"room", "corridor", "street"};
  simulation::SequenceRecipe recipe;
  int frames = 150;
  app.add_option("worlds", worlds, "room, corridor, street");
  app.add_option("--frames", frames, "Of each sequence");
  app.add_option("--seed", recipe.seed, "Of the worlds and the noise");
  app.add_option("--read-noise", recipe.sensor.read_noise, "Standard deviation of the sensor's dark noise");
  app.add_option("--shot-noise", recipe.sensor.shot_noise, "Variance of the photon noise per unit of irradiance");
  CLI11_PARSE(app, argc, argv);
  std::printf("%-10s %9s %8s %10s %10s %10s %11s\n", "", "", "", "relative", "squared error", "", "");
  std::printf("%-10s %9s %8s %10s %10s %10s %11s\n", "world", "keyframes", "points", "error", "median", "mean",
              "outliers");
  ThreadPool pool(2);
  for (const std::string& world : worlds) {
    recipe.world = world;
    recipe.frames = frames;
    print(world, test::depth_errors(simulation::make_sequence(recipe, &pool), Settings{}, frames, pool));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace ldso

int main(int argc, char** argv) {
  try {
    return ldso::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "depth_truth: %s\n", error.what());
    return 2;
  }
}
