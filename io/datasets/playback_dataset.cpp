#include "io/datasets/playback_dataset.h"

#include <algorithm>
#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

std::vector<int> played_frames(int size, const DatasetOptions& options) {
  if (options.start < 0) throw Error("--start", "is negative", "the first frame is 0");
  if (options.stride < 1) throw Error("--stride", "is less than 1", "1 uses every frame");
  if (options.start >= size) {
    throw Error("--start " + std::to_string(options.start), "the sequence has only " + std::to_string(size) + " frames",
                "the first frame is 0");
  }
  const int asked = options.end.value_or(size);
  const int end = asked < 0 ? size + std::max(asked, -size) : std::min(asked, size);
  if (end <= options.start) {
    throw Error("--end " + std::to_string(asked), "no frame is left after --start " + std::to_string(options.start),
                "the end is the first frame that is not used any more");
  }
  std::vector<int> frames;
  for (int i = options.start; i < end; i += std::min(options.stride, size)) frames.push_back(i);
  if (options.reverse) std::reverse(frames.begin(), frames.end());
  return frames;
}

class PlaybackDataset final : public Dataset {
 public:
  PlaybackDataset(std::unique_ptr<Dataset> sequence, const DatasetOptions& options)
      : sequence_(std::move(sequence)), frames_(played_frames(sequence_->size(), options)) {}

  int size() const override { return static_cast<int>(frames_.size()); }
  double timestamp(int index) const override { return sequence_->timestamp(source(index)); }
  std::string frame_name(int index) const override { return sequence_->frame_name(source(index)); }
  const Calibration& calibration() const override { return sequence_->calibration(); }
  std::optional<Trajectory> ground_truth() const override { return sequence_->ground_truth(); }
  std::string format_name() const override { return sequence_->format_name(); }
  const std::vector<std::string>& warnings() const override { return sequence_->warnings(); }

  RawFrame read(int index) const override {
    RawFrame frame = sequence_->read(source(index));
    frame.id = index;
    return frame;
  }

  Image<Rgb> read_color(int index) const override { return sequence_->read_color(source(index)); }

 private:
  int source(int index) const { return frames_.at(static_cast<std::size_t>(index)); }

  std::unique_ptr<Dataset> sequence_;
  std::vector<int> frames_;
};

}  // namespace

std::unique_ptr<Dataset> make_playback_dataset(std::unique_ptr<Dataset> sequence, const DatasetOptions& options) {
  return std::make_unique<PlaybackDataset>(std::move(sequence), options);
}

}  // namespace ldso
