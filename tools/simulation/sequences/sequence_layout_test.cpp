#include "simulation/sequences/sequence_layout.h"

#include <gtest/gtest.h>

#include <optional>

#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "ldso/io/trajectory_file.h"
#include "simulation/sequences/sequence_writer.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

/// What is written in a layout is read back by the reader of the benchmark.
class Layouts : public ::testing::Test {
 protected:
  Layouts() { fs::remove_all(folder_); }
  ~Layouts() override { fs::remove_all(folder_); }

  static SequenceRecipe tiny(const std::string& lens) {
    SequenceRecipe recipe;
    recipe.world = "corridor";
    recipe.lens = lens;
    recipe.texel_scale = 8;
    recipe.width = 160;
    recipe.height = 120;
    recipe.frames = 21;
    return recipe;
  }

  void write(const fs::path& folder, const WriteOptions& options) {
    write_sequence(*sequence_, recipe_, folder, options, pool_, nullptr);
  }
  void make(const SequenceRecipe& recipe) {
    recipe_ = recipe;
    sequence_.emplace(make_sequence(recipe, nullptr));
  }

  void expect_frames(const Dataset& dataset, double first_time) const {
    ASSERT_EQ(dataset.size(), 21);
    EXPECT_TRUE(dataset.warnings().empty());
    for (const int i : {0, 13, 20}) {
      const RawFrame expected = sequence_->render(i), frame = dataset.read(i);
      EXPECT_NEAR(frame.timestamp - first_time, expected.timestamp, 1e-6);
      for (std::size_t k = 0; k < frame.grey.size(); ++k) ASSERT_EQ(frame.grey.data()[k], expected.grey.data()[k]);
    }
  }

  void expect_camera(const Dataset& dataset, CameraModelKind model) const {
    const CameraCalibration &read = dataset.calibration().camera, &expected = sequence_->calibration().camera;
    EXPECT_EQ(read.model, model);
    EXPECT_EQ(read.width, expected.width);
    EXPECT_DOUBLE_EQ(read.fx, expected.fx);
    EXPECT_DOUBLE_EQ(read.fy, expected.fy);
    EXPECT_DOUBLE_EQ(read.cx, expected.cx);
    EXPECT_DOUBLE_EQ(read.cy, expected.cy);
    for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(read.distortion[i], expected.distortion[i]);
  }

  /// Pose k of the truth is that of frame `indices[k]`, seen from the world or from the first camera.
  void expect_truth(const Dataset& dataset, const std::vector<int>& indices, const SE3d& T_truth_world) const {
    const Trajectory truth = dataset.ground_truth().value();
    ASSERT_EQ(truth.size(), indices.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const SE3d expected = T_truth_world * sequence_->T_world_camera(indices[k]);
      EXPECT_NEAR(truth[k].timestamp, dataset.timestamp(indices[k]), 1e-6);
      EXPECT_LT((truth[k].T_world_camera.inverse() * expected).log().norm(), 1e-8) << k;
    }
  }

  static std::vector<int> all() {
    std::vector<int> indices;
    for (int i = 0; i < 21; ++i) indices.push_back(i);
    return indices;
  }

  fs::path folder_ =
      fs::temp_directory_path() / "ldso_layouts" / ::testing::UnitTest::GetInstance()->current_test_info()->name();
  ThreadPool pool_{2};
  SequenceRecipe recipe_;
  std::optional<SimulatedSequence> sequence_;
};

TEST_F(Layouts, TumMonoWithTruthAtTheEnds) {
  make(tiny("fov"));
  write(folder_, {});
  EXPECT_TRUE(fs::exists(folder_ / "groundtruth.txt"));
  WriteOptions options;
  options.truth_at_ends = true;
  write(folder_, options);
  EXPECT_FALSE(fs::exists(folder_ / "groundtruth.txt")) << "the truth of the first time";
  EXPECT_EQ(TextFile(folder_ / "groundtruthSync.txt").lines().size(), 21u) << "a row for each frame";
  int skipped = 0;
  read_tum_trajectory(folder_ / "groundtruthSync.txt", &skipped);
  EXPECT_EQ(skipped, 15);
  const auto dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format_name(), "TUM-mono");
  expect_frames(*dataset, 0);
  expect_camera(*dataset, CameraModelKind::kFov);
  expect_truth(*dataset, {0, 1, 2, 18, 19, 20}, SE3d());
}

TEST_F(Layouts, Euroc) {
  for (const auto& [lens, model] :
       {std::pair{"radtan", CameraModelKind::kRadTan}, std::pair{"kannala-brandt", CameraModelKind::kKannalaBrandt},
        std::pair{"pinhole", CameraModelKind::kPinhole}}) {
    make(tiny(lens));
    WriteOptions options;
    options.layout = LayoutKind::kEuroc;
    options.depth = true;
    write(folder_, options);
    const auto dataset = open_dataset(folder_);
    EXPECT_EQ(dataset->format_name(), "EuRoC");
    expect_frames(*dataset, 1403636579);
    expect_camera(*dataset, model);
    expect_truth(*dataset, all(), SE3d());
    EXPECT_TRUE(fs::exists(folder_ / "depth" / "1403636579000000000.png"));
  }
  // The file holds the poses of the body, not those of the camera.
  const Trajectory body = read_euroc_ground_truth(folder_ / "mav0/state_groundtruth_estimate0/data.csv");
  EXPECT_GT((body[5].T_world_camera.inverse() * sequence_->T_world_camera(5)).log().norm(), 0.5);
}

TEST_F(Layouts, Kitti) {
  make(tiny("pinhole"));
  WriteOptions options;
  options.layout = LayoutKind::kKitti;
  const fs::path folder = folder_ / "sequences" / "07";
  write(folder, options);
  EXPECT_TRUE(fs::exists(folder_ / "poses" / "07.txt"));
  const auto dataset = open_dataset(folder);
  EXPECT_EQ(dataset->format_name(), "KITTI");
  expect_frames(*dataset, 0);
  expect_camera(*dataset, CameraModelKind::kPinhole);
  expect_truth(*dataset, all(), sequence_->T_world_camera(0).inverse());
}

TEST_F(Layouts, WhatALayoutCannotExpressIsRefused) {
  make(tiny("fov"));
  WriteOptions options;
  options.layout = LayoutKind::kEuroc;
  EXPECT_THROW(write(folder_, options), Error);
  options.layout = LayoutKind::kKitti;
  EXPECT_THROW(write(folder_ / "sequences" / "00", options), Error);
  make(tiny("pinhole"));
  EXPECT_THROW(write(folder_ / "elsewhere" / "00", options), Error);
  options.layout = LayoutKind::kEuroc;
  options.zip = true;
  EXPECT_THROW(write(folder_, options), Error);
  EXPECT_FALSE(fs::exists(folder_)) << "refused before anything is written";
}

TEST_F(Layouts, NothingOfALongerSequenceIsLeft) {
  SequenceRecipe recipe = tiny("pinhole");
  recipe.fps = 60;
  make(recipe);
  WriteOptions options;
  options.layout = LayoutKind::kEuroc;
  write(folder_, options);
  make(tiny("pinhole"));
  write(folder_, options);
  int images = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "mav0/cam0/data")) ++images;
  EXPECT_EQ(images, 21);
}

}  // namespace
}  // namespace ldso::simulation
