#pragma once

// Idea: a simulated sequence as a folder in the layout of a benchmark, so that everything that reads sequences reads
// it.

#include <filesystem>
#include <functional>

#include "simulation/sequences/sequence_recipe.h"

namespace ldso::simulation {

enum class LayoutKind { kTumMono, kEuroc, kKitti };

struct WriteOptions {
  LayoutKind layout = LayoutKind::kTumMono;
  bool zip = false;            ///< TUM-mono: images.zip instead of a folder of images.
  bool truth_at_ends = false;  ///< TUM-mono: groundtruthSync.txt with the start and the end alone, as in the benchmark.
  bool depth = false;  ///< Also depth/NAME.png: z of each pixel of the raw image, 16 bit, unit in world.yaml, 0: sky.
};

/// Unit of the depth maps [m].
double depth_unit(const SequenceRecipe& recipe);

/// Writes to `folder` (made if missing) what sequence_layout.h says of the layout: images, times, calibration if it is
/// provided and not trivial, ground truth (camera-to-world, every frame); and, last of all, world.yaml: where it is,
/// the sequence is complete. `progress(done)` is called now and then and stops the writing by returning false; what is
/// written so far is then completed. Returns the number of frames. Throws Error if something cannot be written or the
/// layout cannot express it.
int write_sequence(const SimulatedSequence& sequence, const SequenceRecipe& recipe, const std::filesystem::path& folder,
                   const WriteOptions& options, ThreadPool& pool, const std::function<bool(int)>& progress);

}  // namespace ldso::simulation
