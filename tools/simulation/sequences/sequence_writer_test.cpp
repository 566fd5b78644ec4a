#include "simulation/sequences/sequence_writer.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>

#include "ldso/io/dataset.h"
#include "ldso/io/trajectory_file.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

class SequenceWriter : public ::testing::Test {
 protected:
  SequenceWriter() : folder_(fs::temp_directory_path() / ("ldso_writer_" + std::string(test_name()))) {
    fs::remove_all(folder_);
  }
  ~SequenceWriter() override { fs::remove_all(folder_); }

  static const char* test_name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }

  static SequenceRecipe tiny() {
    SequenceRecipe recipe;
    recipe.world = "corridor";
    recipe.texel_scale = 8;
    recipe.width = 160;
    recipe.height = 120;
    recipe.frames = 9;
    return recipe;
  }

  /// The sequence of tiny(), made once.
  static const SimulatedSequence& sequence() {
    static const SimulatedSequence kMade = make_sequence(tiny(), nullptr);
    return kMade;
  }

  fs::path folder_;
  ThreadPool pool_{2};
};

TEST_F(SequenceWriter, IsReadBackAsItWasRendered) {
  const SequenceRecipe recipe = tiny();
  EXPECT_EQ(write_sequence(sequence(), recipe, folder_, {}, pool_, nullptr), 9);
  const auto dataset = open_dataset(folder_);
  ASSERT_EQ(dataset->size(), 9);
  EXPECT_TRUE(dataset->warnings().empty());
  for (const int i : {0, 8}) {
    const RawFrame expected = sequence().render(i), frame = dataset->read(i);
    EXPECT_NEAR(frame.timestamp, expected.timestamp, 1e-8);
    ASSERT_TRUE(frame.exposure_ms.has_value());
    EXPECT_NEAR(*frame.exposure_ms, *expected.exposure_ms, 1e-8);
    for (std::size_t k = 0; k < frame.grey.size(); ++k) ASSERT_EQ(frame.grey.data()[k], expected.grey.data()[k]);
  }
  const Trajectory truth = dataset->ground_truth().value();
  ASSERT_EQ(truth.size(), 9u);
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT((truth[i].T_world_camera.inverse() * sequence().T_world_camera(i)).log().norm(), 1e-8);
  }
}

TEST_F(SequenceWriter, CalibrationIsReadBack) {
  const SequenceRecipe recipe = tiny();
  write_sequence(sequence(), recipe, folder_, {}, pool_, nullptr);
  const auto dataset = open_dataset(folder_);
  const Calibration &read = dataset->calibration(), &expected = sequence().calibration();
  EXPECT_EQ(read.camera.model, CameraModelKind::kFov);
  EXPECT_EQ(read.camera.width, 160);
  EXPECT_DOUBLE_EQ(read.camera.fx, expected.camera.fx);
  EXPECT_DOUBLE_EQ(read.camera.cy, expected.camera.cy);
  EXPECT_DOUBLE_EQ(read.camera.distortion[0], expected.camera.distortion[0]);
  EXPECT_EQ(read.rectification.mode, RectificationMode::kCrop);
  ASSERT_TRUE(read.photometric.inverse_response.has_value());
  for (int i = 0; i < 256; ++i) {
    EXPECT_NEAR((*read.photometric.inverse_response)[i], (*expected.photometric.inverse_response)[i], 1e-3f);
  }
  ASSERT_EQ(read.photometric.vignette.size(), expected.photometric.vignette.size());
  EXPECT_NEAR(read.photometric.vignette(3, 2), expected.photometric.vignette(3, 2), 1e-3f);
}

TEST_F(SequenceWriter, ArchiveHoldsTheSameImages) {
  const SequenceRecipe recipe = tiny();
  WriteOptions options;
  options.zip = true;
  write_sequence(sequence(), recipe, folder_, options, pool_, nullptr);
  EXPECT_TRUE(fs::exists(folder_ / "images.zip"));
  EXPECT_FALSE(fs::exists(folder_ / "images"));
  const RawFrame expected = sequence().render(5), frame = open_dataset(folder_)->read(5);
  for (std::size_t k = 0; k < frame.grey.size(); ++k) ASSERT_EQ(frame.grey.data()[k], expected.grey.data()[k]);
}

TEST_F(SequenceWriter, LeavesNothingOfALongerRunBefore) {
  SequenceRecipe recipe = tiny();
  WriteOptions options;
  options.depth = true;
  write_sequence(sequence(), recipe, folder_, options, pool_, nullptr);
  EXPECT_TRUE(fs::exists(folder_ / "depth" / "00008.png"));
  recipe.frames = 4;
  recipe.provide_calibration = recipe.provide_exposure = false;
  write_sequence(make_sequence(recipe, &pool_), recipe, folder_, {}, pool_, nullptr);
  EXPECT_FALSE(fs::exists(folder_ / "images" / "00004.png"));
  EXPECT_FALSE(fs::exists(folder_ / "depth"));
  const auto dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->size(), 4);
  EXPECT_FALSE(dataset->read(1).exposure_ms.has_value());
  EXPECT_FALSE(dataset->calibration().photometric.inverse_response.has_value());
  EXPECT_TRUE(dataset->calibration().photometric.vignette.empty());
}

TEST_F(SequenceWriter, StopsWhenAskedAndCompletesWhatThereIs) {
  const SequenceRecipe recipe = tiny();
  const int frames = write_sequence(sequence(), recipe, folder_, {}, pool_, [](int) { return false; });
  EXPECT_GT(frames, 0);
  EXPECT_LT(frames, 9);
  EXPECT_EQ(open_dataset(folder_)->size(), frames);
}

TEST_F(SequenceWriter, DescribesTheWorld) {
  const SequenceRecipe recipe = tiny();
  write_sequence(sequence(), recipe, folder_, {}, pool_, nullptr);
  const YAML::Node world = YAML::LoadFile((folder_ / "world.yaml").string());
  EXPECT_EQ(world["world"].as<std::string>(), "corridor");
  EXPECT_EQ(world["seed"].as<int>(), 1);
  EXPECT_EQ(world["frames"].as<int>(), 9);
  EXPECT_EQ(world["camera"]["model"].as<std::string>(), "FOV");
}

TEST_F(SequenceWriter, DescribesStyleAndMotionWhereTheyAreChosen) {
  SequenceRecipe recipe = tiny();
  recipe.frames = 1;
  recipe.world = "wall";
  recipe.motion = "orbit";
  write_sequence(make_sequence(recipe, nullptr), recipe, folder_, {}, pool_, nullptr);
  EXPECT_EQ(YAML::LoadFile((folder_ / "world.yaml").string())["motion"].as<std::string>(), "orbit");
  recipe.world = "room";
  recipe.motion.clear();
  recipe.style = "dark";
  write_sequence(make_sequence(recipe, nullptr), recipe, folder_, {}, pool_, nullptr);
  const YAML::Node world = YAML::LoadFile((folder_ / "world.yaml").string());
  EXPECT_EQ(world["style"].as<std::string>(), "dark");
  EXPECT_FALSE(world["motion"]);
}

/// A drive up a hill and round a bend, written and read as KITTI poses.
TEST_F(SequenceWriter, StreetsGrowAlongAGivenTrajectory) {
  fs::create_directories(folder_);
  Trajectory trajectory;
  SE3d pose;
  for (int i = 0; i < 120; ++i) {
    trajectory.push_back({0.1 * i, pose});
    pose = pose * SE3d(SO3d::exp({0.002 * std::sin(0.1 * i), i > 60 && i < 100 ? 0.03 : 0.0, 0}), {0, 0, 0.8});
  }
  write_kitti_poses(folder_ / "poses.txt", trajectory);
  SequenceRecipe recipe;
  recipe.world = "street";
  recipe.texel_scale = 6;
  recipe.width = 306;
  recipe.height = 92;
  recipe.trajectory = folder_ / "poses.txt";
  const SimulatedSequence sequence = make_sequence(recipe, &pool_);
  ASSERT_EQ(sequence.size(), 120);
  for (int i = 0; i < 120; i += 7) {
    EXPECT_LT((sequence.T_world_camera(i).inverse() * trajectory[i].T_world_camera).log().norm(), 1e-9);
    const Image<float> depth = sequence.depth(i);
    // The road lies where a car has it, and nothing stands on it.
    const CameraCalibration& camera = sequence.calibration().camera;
    EXPECT_NEAR(depth(150, 91), 1.65 * camera.fy / (91 - camera.cy), 2.0) << i;
    for (int u = 130; u < 170; ++u) EXPECT_GT(depth(u, 60), 3) << i;
  }
}

}  // namespace
}  // namespace ldso::simulation
