#include "io/datasets/playback_dataset.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

using Frames = std::vector<int>;

/// Frame i has time i and a single pixel i.
class CountingDataset final : public Dataset {
 public:
  int size() const override { return 10; }
  RawFrame read(int index) const override {
    return {index, timestamp(index), 1.0, Image<float>(1, 1, float(index)), ""};
  }
  double timestamp(int index) const override { return index; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return Trajectory{{0, SE3d()}}; }
  std::string format_name() const override { return "counting"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  Calibration calibration_;
  std::vector<std::string> warnings_{"odd"};
};

Frames played(const DatasetOptions& options) {
  const auto dataset = make_playback_dataset(std::make_unique<CountingDataset>(), options);
  Frames frames;
  for (int i = 0; i < dataset->size(); ++i) {
    const RawFrame frame = dataset->read(i);
    EXPECT_EQ(frame.id, i);
    EXPECT_EQ(frame.timestamp, frame.grey(0, 0)) << "timestamps stay those of the sequence";
    EXPECT_EQ(dataset->timestamp(i), frame.timestamp);
    frames.push_back(static_cast<int>(frame.grey(0, 0)));
  }
  return frames;
}

TEST(PlaybackDataset, PlaysEverythingByDefault) { EXPECT_EQ(played({}), (Frames{0, 1, 2, 3, 4, 5, 6, 7, 8, 9})); }

TEST(PlaybackDataset, StartEndStrideAndReverse) {
  EXPECT_EQ(played({.start = 7}), (Frames{7, 8, 9}));
  EXPECT_EQ(played({.end = 3}), (Frames{0, 1, 2}));
  EXPECT_EQ(played({.start = 2, .end = 9, .stride = 3}), (Frames{2, 5, 8}));
  EXPECT_EQ(played({.start = 2, .end = 9, .stride = 3, .reverse = true}), (Frames{8, 5, 2}));
  EXPECT_EQ(played({.end = 100}).size(), 10U);
  EXPECT_EQ(played({.stride = 2147483647}), (Frames{0}));
  EXPECT_EQ(played({.start = 5, .end = -2}), (Frames{5, 6, 7}));
  EXPECT_EQ(played({.start = 6, .end = -1, .reverse = true}), (Frames{8, 7, 6}));
}

TEST(PlaybackDataset, PassesTheRestThrough) {
  const auto dataset = make_playback_dataset(std::make_unique<CountingDataset>(), {.start = 3});
  EXPECT_EQ(dataset->format_name(), "counting");
  EXPECT_EQ(dataset->warnings(), std::vector<std::string>{"odd"});
  EXPECT_EQ(dataset->ground_truth()->size(), 1U);
}

TEST(PlaybackDataset, NothingToPlayIsAnError) {
  EXPECT_NE(error_of([] { played({.start = 10}); }).find("has only 10 frames"), std::string::npos);
  EXPECT_NE(error_of([] { played({.start = -1}); }).find("--start"), std::string::npos);
  EXPECT_NE(error_of([] { played({.start = 5, .end = 5}); }).find("--end"), std::string::npos);
  EXPECT_NE(error_of([] { played({.start = 5, .end = -5}); }).find("--end -5"), std::string::npos);
  EXPECT_NE(error_of([] { played({.end = -2147483647 - 1}); }).find("no frame is left"), std::string::npos);
  EXPECT_NE(error_of([] { played({.stride = 0}); }).find("--stride"), std::string::npos);
}

}  // namespace
}  // namespace ldso
