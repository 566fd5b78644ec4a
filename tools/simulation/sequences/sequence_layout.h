#pragma once

// Idea: what a benchmark's folder of a sequence looks like, one file a benchmark. The writer renders, a layout says
// where things go.

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "simulation/sequences/sequence_recipe.h"

namespace ldso::simulation {

class SequenceLayout {
 public:
  virtual ~SequenceLayout() = default;

  /// Throws Error if the layout cannot express the sequence, or if it cannot lie in this folder.
  virtual void check(const SimulatedSequence& sequence, const std::filesystem::path& folder) const = 0;
  /// Relative to the sequence's folder.
  virtual std::filesystem::path image_folder() const = 0;
  /// Digits, at least five; without extension.
  virtual std::string frame_name(const SimulatedSequence& sequence, int index) const = 0;
  /// All that may be written into the folder or beside it, relative to it; folders end in "/".
  virtual std::vector<std::string> names(const std::filesystem::path& folder) const = 0;
  /// Everything but images, for the first `frames` frames.
  virtual void write(const std::filesystem::path& folder, const SimulatedSequence& sequence,
                     const SequenceRecipe& recipe, int frames) const = 0;
};

/// times.txt, camera.txt, pcalib.txt, vignette.png, and groundtruth.txt with every frame. With `truth_at_ends`, instead
/// of it, groundtruthSync.txt as in the benchmark: a row for every frame, poses in the first and the last 15 % of them,
/// NaN between.
std::unique_ptr<SequenceLayout> make_tum_mono_layout(bool truth_at_ends);

/// mav0/cam0 with sensor.yaml, data.csv and data/<ns>.png; mav0/state_groundtruth_estimate0/data.csv with the poses of
/// a body to which the camera is mounted like that of the benchmark. Response, vignette and exposure have no place
/// there.
std::unique_ptr<SequenceLayout> make_euroc_layout();

/// ROOT/sequences/NN with image_0, calib.txt and times.txt; ROOT/poses/NN.txt relative to the first camera. Pinhole
/// cameras only. Response, vignette and exposure have no place there.
std::unique_ptr<SequenceLayout> make_kitti_layout();

/// "00042": index with at least so many digits.
std::string numbered(int index, int digits);

}  // namespace ldso::simulation
