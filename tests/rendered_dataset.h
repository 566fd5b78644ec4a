#pragma once
// A rendered sequence in memory, whose frames, times and calibration a test may damage.

#include <optional>
#include <string>
#include <vector>

#include "ldso/io/dataset.h"
#include "simulation/sequences/sequence_recipe.h"

namespace ldso::test {

class RenderedDataset final : public Dataset {
 public:
  explicit RenderedDataset(const simulation::SequenceRecipe& recipe) {
    ThreadPool pool(2);
    const simulation::SimulatedSequence sequence = simulation::make_sequence(recipe, &pool);
    camera = sequence.calibration();
    for (int i = 0; i < sequence.size(); ++i) frames.push_back(sequence.render(i, &pool));
  }
  RenderedDataset(const RenderedDataset& other) : Dataset(), frames(other.frames), camera(other.camera) {}

  std::vector<RawFrame> frames;
  Calibration camera;

  int size() const override { return static_cast<int>(frames.size()); }
  RawFrame read(int index) const override {
    RawFrame frame = frames.at(static_cast<std::size_t>(index));
    frame.id = index;
    return frame;
  }
  double timestamp(int index) const override { return frames.at(static_cast<std::size_t>(index)).timestamp; }
  const Calibration& calibration() const override { return camera; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "rendered"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  std::vector<std::string> warnings_;
};

}  // namespace ldso::test
