#pragma once

// Idea: a simulated sequence as a folder in the layout of the TUM-mono benchmark, so that everything that reads
// sequences reads it.

#include <filesystem>
#include <functional>

#include "simulation/sequence_recipe.h"

namespace ldso::simulation {

struct WriteOptions {
  bool zip = false;    ///< images.zip instead of a folder of images.
  bool depth = false;  ///< Also depth/NNNNN.png: z of each pixel of the raw image, 16 bit, unit in world.yaml, 0: sky.
};

/// Unit of the depth maps [m].
double depth_unit(const SequenceRecipe& recipe);

/// Writes to `folder` (made if missing): images/NNNNN.png or images.zip, times.txt, camera.txt, pcalib.txt and
/// vignette.png if the calibration is provided and not trivial, groundtruth.txt (camera-to-world, every frame) and
/// world.yaml. `progress(done)` is called now and then and stops the writing by returning false; what is written so far
/// is then completed. Returns the number of frames. Throws Error if something cannot be written.
int write_sequence(const SimulatedSequence& sequence, const SequenceRecipe& recipe, const std::filesystem::path& folder,
                   const WriteOptions& options, ThreadPool& pool, const std::function<bool(int)>& progress);

}  // namespace ldso::simulation
