// Real sequences, whose licences forbid to copy them here: the folder that contains them is named by LDSO_DATA.

#include <gtest/gtest.h>

#include <cstdlib>

#include "ldso/io/dataset.h"

namespace ldso {
namespace {

struct RealSequence {
  const char* name;
  const char* folder;
  const char* format_name;
  int frames;
  int width;
  int height;
  bool has_ground_truth;
};

class RealData : public testing::TestWithParam<RealSequence> {};

TEST_P(RealData, IsReadWithCalibrationAndGroundTruth) {
  const char* data = std::getenv("LDSO_DATA");
  if (data == nullptr) GTEST_SKIP() << "set LDSO_DATA to the folder of the real sequences to run this test";
  const std::filesystem::path path = std::filesystem::path(data) / GetParam().folder;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  const auto dataset = open_dataset(path);
  EXPECT_EQ(dataset->format_name(), GetParam().format_name);
  ASSERT_EQ(dataset->size(), GetParam().frames);
  EXPECT_EQ(dataset->calibration().camera.width, GetParam().width);
  EXPECT_EQ(dataset->calibration().camera.height, GetParam().height);
  EXPECT_TRUE(dataset->warnings().empty());
  ASSERT_EQ(dataset->ground_truth().has_value(), GetParam().has_ground_truth);
  if (GetParam().has_ground_truth) {
    EXPECT_EQ(dataset->ground_truth()->size(), static_cast<std::size_t>(GetParam().frames));
  }
  for (const int index : {0, dataset->size() / 2, dataset->size() - 1}) {
    EXPECT_EQ(dataset->read(index).grey.width(), GetParam().width);
  }
}

INSTANTIATE_TEST_SUITE_P(Sequences, RealData,
                         testing::Values(RealSequence{"Kitchen", "7scenes_kitchen", "TUM-mono", 1000, 640, 480, true},
                                         RealSequence{"Kitti00", "kitti/sequences/00", "KITTI", 1018, 416, 128, true},
                                         RealSequence{"Kitti05", "kitti/sequences/05", "KITTI", 60, 1226, 370, true},
                                         RealSequence{"Kitti06", "kitti/sequences/06", "KITTI", 51, 1226, 370, true},
                                         RealSequence{"EurocV101", "euroc/V1_01_first95", "EuRoC", 95, 752, 480,
                                                      false}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace ldso
