#include "io/datasets/tum_mono_dataset.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"

namespace ldso {
namespace {

TEST(TumMonoDataset, CarriesExposureCalibrationAndGroundTruth) {
  const TemporaryFolder folder;
  const auto dataset = open_tum_mono(make_tum_mono(folder.path(), 5), {});
  EXPECT_EQ(dataset->read(3).exposure_ms, 2.5);
  EXPECT_EQ(dataset->calibration().camera.fy, 41);
  EXPECT_TRUE(dataset->warnings().empty());
  const auto truth = dataset->ground_truth();
  ASSERT_TRUE(truth.has_value());
  EXPECT_EQ((*truth)[4].T_world_camera.translation().x(), 4);
  EXPECT_NEAR((*truth)[4].timestamp, dataset->timestamp(4), 1e-9);
}

TEST(TumMonoDataset, GroundTruthOfTheBenchmarkHasGaps) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 3);
  std::filesystem::remove(folder / "groundtruth.txt");
  write_text(folder / "groundtruthSync.txt", "0.0 1 0 0 0 0 0 1\n0.1 NaN NaN NaN NaN NaN NaN NaN\n0.2 2 0 0 0 0 0 1\n");
  EXPECT_EQ(open_tum_mono(folder.path(), {})->ground_truth()->size(), 2U);
}

TEST(TumMonoDataset, BrokenGroundTruthIsAWarning) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 3);
  write_text(folder / "groundtruth.txt", "what is this\n");
  const auto dataset = open_tum_mono(folder.path(), {});
  EXPECT_FALSE(dataset->ground_truth().has_value());
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("groundtruth.txt:1"), std::string::npos) << dataset->warnings()[0];
}

TEST(TumMonoDataset, ReadsThePhotometricCalibration) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 2);
  std::string table;
  for (int i = 0; i < 256; ++i) table += std::to_string(i * i) + " ";
  write_text(folder / "pcalib.txt", table);
  const Image<float> vignette(kTestWidth, kTestHeight, 100.0F);
  write_grey16_png(folder / "vignette.png", vignette.view());
  const auto dataset = open_tum_mono(folder.path(), {});
  EXPECT_TRUE(dataset->calibration().photometric.inverse_response.has_value());
  EXPECT_EQ(dataset->calibration().photometric.vignette(3, 4), 1.0F);
}

TEST(TumMonoDataset, VignetteOfAnotherSizeIsAnError) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 2);
  const Image<float> vignette(8, 6, 100.0F);
  write_grey16_png(folder / "vignette.png", vignette.view());
  EXPECT_NE(error_of([&] { open_tum_mono(folder.path(), {}); }).find("vignette is 8x6"), std::string::npos);
}

TEST(TumMonoDataset, TimesThatDoNotIncreaseAreAWarning) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 3);
  write_text(folder / "times.txt", "00000 0.0\n00001 0.5\n00002 0.2\n");
  const auto dataset = open_tum_mono(folder.path(), {});
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("1 timestamps are not later"), std::string::npos) << dataset->warnings()[0];
}

}  // namespace
}  // namespace ldso
