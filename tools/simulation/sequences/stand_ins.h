#pragma once

// Idea: small rendered sets that stand in for the benchmarks: the same layouts, the same kind of ground truth, so that
// whole experiments run without any download.

#include <filesystem>
#include <string>
#include <vector>

#include "simulation/sequences/sequence_recipe.h"
#include "simulation/sequences/sequence_writer.h"

namespace ldso::simulation {

enum class StandInSize {
  kSmall,  ///< One short sequence a benchmark, in small images: for tests.
  kFull,   ///< Two a benchmark.
};

struct StandIn {
  std::string dataset;         ///< tum_mono, euroc or kitti: its root is the folder of this name.
  std::filesystem::path path;  ///< Of the sequence, relative to the folder that holds the three roots.
  SequenceRecipe recipe;
  WriteOptions write;
};

/// - tum_mono: walks that end where they began, ground truth at both ends alone; response, vignette and exposure known.
/// - euroc: hand-held flights through rooms; exposure changes, of which nothing is told.
/// - kitti: drives round blocks of houses.
std::vector<StandIn> stand_ins(StandInSize size);

}  // namespace ldso::simulation
