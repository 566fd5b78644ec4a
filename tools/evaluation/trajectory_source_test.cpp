#include "evaluation/trajectory_source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKittiPoses = "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 2 0 0 1 3\n";

class TrajectorySource : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("ldso_trajectory_source_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const fs::path& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(TrajectorySource, ReadsTumAndCountsRowsWithoutPose) {
  const auto path =
      write("a.txt", "# comment\n1.5 1 2 3 0 0 0 1\n2.5 nan nan nan nan nan nan nan\n3.5 1 2 4 0 0 0 1\n");
  const LoadedTrajectory loaded = load_trajectory(path);
  ASSERT_EQ(loaded.poses.size(), 2u);
  EXPECT_TRUE(loaded.has_times);
  EXPECT_DOUBLE_EQ(loaded.poses[1].timestamp, 3.5);
  EXPECT_EQ(loaded.description, "TUM, 1 rows without pose");
}

TEST_F(TrajectorySource, KittiWithoutTimesCounts) {
  const LoadedTrajectory loaded = load_trajectory(write("a.txt", kKittiPoses));
  ASSERT_EQ(loaded.poses.size(), 2u);
  EXPECT_FALSE(loaded.has_times);
  EXPECT_DOUBLE_EQ(loaded.poses[1].timestamp, 1);
  EXPECT_DOUBLE_EQ(loaded.poses[1].T_world_camera.translation().z(), 3);
}

TEST_F(TrajectorySource, KittiFindsItsTimes) {
  const auto path = write("poses/07.txt", kKittiPoses);
  write("sequences/07/times.txt", "0.25\n0.5\n");
  const LoadedTrajectory loaded = load_trajectory(path);
  EXPECT_TRUE(loaded.has_times);
  EXPECT_DOUBLE_EQ(loaded.poses[1].timestamp, 0.5);
  const auto given = write("given.txt", "7\n8\n");
  EXPECT_DOUBLE_EQ(load_trajectory(path, given).poses[1].timestamp, 8);
}

TEST_F(TrajectorySource, ReadsEuroc) {
  const auto path = write("data.csv", "#timestamp,p_x,p_y,p_z,q_w,q_x,q_y,q_z\n1403715273262142976,1,2,3,1,0,0,0\n");
  const LoadedTrajectory loaded = load_trajectory(path);
  ASSERT_EQ(loaded.poses.size(), 1u);
  EXPECT_NEAR(loaded.poses[0].timestamp, 1403715273.262142976, 1e-6);
}

TEST_F(TrajectorySource, MissingFileIsAnError) { EXPECT_THROW(load_trajectory(folder_ / "none.txt"), Error); }

}  // namespace
}  // namespace ldso
