#include "io/datasets/kitti_dataset.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(KittiDataset, CarriesCalibrationAndGroundTruth) {
  const TemporaryFolder folder;
  const auto dataset = open_kitti(make_kitti(folder.path(), 4), {});
  const CameraCalibration& camera = dataset->calibration().camera;
  EXPECT_EQ(camera.model, CameraModelKind::kPinhole);
  EXPECT_EQ(camera.width, kTestWidth);
  EXPECT_EQ(camera.height, kTestHeight);
  EXPECT_EQ(camera.fx, 40);
  EXPECT_EQ(camera.cy, 11.5);
  EXPECT_EQ(dataset->calibration().rectification.mode, RectificationMode::kNone);
  ASSERT_TRUE(dataset->ground_truth().has_value());
  EXPECT_EQ(dataset->ground_truth()->at(3).T_world_camera.translation().x(), 3);
  EXPECT_NEAR(dataset->ground_truth()->at(3).timestamp, 0.3, 1e-9);
}

TEST(KittiDataset, ATrailingSlashDoesNotHideTheGroundTruth) {
  const TemporaryFolder folder;
  EXPECT_TRUE(open_kitti(make_kitti(folder.path(), 2) / "", {})->ground_truth().has_value());
}

TEST(KittiDataset, UsesTheColourCameraWhereThereIsNoGreyOne) {
  const TemporaryFolder folder;
  const fs::path sequence = make_kitti(folder.path(), 2);
  fs::rename(sequence / "image_0", sequence / "image_2");
  const auto dataset = open_kitti(sequence, {});
  // P2 = K [I | (0.5, 0, 0)]: camera 0 is at x = 0.5 of camera 2, so camera 2 is at -0.5 of camera 0.
  EXPECT_NEAR(dataset->ground_truth()->at(1).T_world_camera.translation().x(), 1 - 0.5, 1e-12);
  EXPECT_NE(dataset->calibration().description.find("P2"), std::string::npos);
}

TEST(KittiDataset, MissingFilesAreNamed) {
  for (const char* name : {"calib.txt", "times.txt"}) {
    const TemporaryFolder folder;
    const fs::path sequence = make_kitti(folder.path(), 2);
    fs::remove(sequence / name);
    const std::string message = error_of([&] { open_kitti(sequence, {}); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(KittiDataset, PosesOfAnotherLengthAreAWarning) {
  const TemporaryFolder folder;
  const fs::path sequence = make_kitti(folder.path(), 3);
  write_text(folder / "poses/07.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto dataset = open_kitti(sequence, {});
  EXPECT_FALSE(dataset->ground_truth().has_value());
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("1 poses for 3 times"), std::string::npos) << dataset->warnings()[0];
}

TEST(KittiDataset, WithoutTimesNeedsARate) {
  const TemporaryFolder folder;
  const auto path = make_kitti(folder.path(), 3);
  std::filesystem::remove(path / "times.txt");
  EXPECT_NE(error_of([&] { open_kitti(path, {}); }).find("--fps"), std::string::npos);
  const auto dataset = open_kitti(path, {.fps = 4});
  EXPECT_DOUBLE_EQ(dataset->timestamp(2), 0.5);
  EXPECT_DOUBLE_EQ(dataset->ground_truth()->at(2).timestamp, 0.5);
}

}  // namespace
}  // namespace ldso
