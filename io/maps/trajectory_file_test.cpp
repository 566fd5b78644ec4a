#include "ldso/io/trajectory_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/datasets/test_sequences.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

Trajectory sample_trajectory() {
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i) {
    SE3d::Tangent x;
    x << 100.0 * i, -3.25 * i, 1e-4 * i, 0.1 * i, -0.05 * i, 0.02 * i;
    trajectory.push_back({1403715273.262142976 + 0.05 * i, SE3d::exp(x)});
  }
  return trajectory;
}

void expect_equal(const Trajectory& a, const Trajectory& b, double relative) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].timestamp, b[i].timestamp, 1e-6);
    const Eigen::Matrix4d A = a[i].T_world_camera.matrix();
    EXPECT_LT((A - b[i].T_world_camera.matrix()).cwiseAbs().maxCoeff(),
              relative * std::max(1.0, A.cwiseAbs().maxCoeff()));
  }
}

TEST(TrajectoryFile, TumIsReadAsWritten) {
  const TemporaryFolder folder;
  write_tum_trajectory(folder / "t.txt", sample_trajectory());
  expect_equal(sample_trajectory(), read_tum_trajectory(folder / "t.txt"), 1e-10);
  EXPECT_EQ(detect_trajectory_format(folder / "t.txt"), TrajectoryFormat::kTum);
}

TEST(TrajectoryFile, TimestampsKeepTheirBits) {
  const TemporaryFolder folder;
  const Trajectory trajectory = sample_trajectory();
  write_tum_trajectory(folder / "t.txt", trajectory);
  const Trajectory read = read_tum_trajectory(folder / "t.txt");
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].timestamp, trajectory[i].timestamp);
}

TEST(TrajectoryFile, KittiIsReadAsWritten) {
  const TemporaryFolder folder;
  const Trajectory trajectory = sample_trajectory();
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) times.push_back(pose.timestamp);
  write_kitti_poses(folder / "t.txt", trajectory);
  expect_equal(trajectory, read_kitti_poses(folder / "t.txt", times), 1e-11);
  EXPECT_EQ(detect_trajectory_format(folder / "t.txt"), TrajectoryFormat::kKitti);
}

TEST(TrajectoryFile, EurocQuaternionsBeginWithTheRealPart) {
  const TemporaryFolder folder;
  write_text(folder / "data.csv",
             "#timestamp, p_RS_R_x [m], ...\n1403715274302142976,0.5,1.5,-2,0.8,0,0,0.6,0.1,0.2,0.3\n");
  EXPECT_EQ(detect_trajectory_format(folder / "data.csv"), TrajectoryFormat::kEuroc);
  const Trajectory trajectory = read_euroc_ground_truth(folder / "data.csv");
  ASSERT_EQ(trajectory.size(), 1U);
  EXPECT_DOUBLE_EQ(trajectory[0].timestamp, 1403715274.302142976);
  EXPECT_TRUE(trajectory[0].T_world_camera.translation().isApprox(Eigen::Vector3d(0.5, 1.5, -2)));
  // w = 0.8, z = 0.6 turns x by 2 asin(0.6) about z.
  EXPECT_NEAR(trajectory[0].T_world_camera.rotation_matrix()(1, 0), 2 * 0.8 * 0.6, 1e-12);
}

TEST(TrajectoryFile, NanPosesAreUnknownOnes) {
  const TemporaryFolder folder;
  write_text(folder / "t.txt", "0 1 2 3 0 0 0 1\n1 nan nan nan NaN NaN NaN NaN\n2 1 2 3 0 0 0 1\n");
  int skipped = 0;
  EXPECT_EQ(read_tum_trajectory(folder / "t.txt", &skipped).size(), 2U);
  EXPECT_EQ(skipped, 1);
}

TEST(TrajectoryFile, BadLinesAreNamed) {
  const TemporaryFolder folder;
  const auto message_for = [&](const std::string& line) {
    write_text(folder / "t.txt", "0 1 2 3 0 0 0 1\n" + line + "\n");
    return error_of([&] { read_tum_trajectory(folder / "t.txt"); });
  };
  for (const char* line :
       {"1 2 3", "1 2 3 x 0 0 0 1", "1 2 3 4 0 0 0 0", "1 2 3 4 5 6 7 8", "inf 2 3 4 0 0 0 1", "1 inf 3 4 0 0 0 1"}) {
    const std::string message = message_for(line);
    EXPECT_NE(message.find("t.txt:2"), std::string::npos) << line << " -> " << message;
  }
}

TEST(TrajectoryFile, EurocIsReadAsWritten) {
  const TemporaryFolder folder;
  const Trajectory trajectory = sample_trajectory();
  write_euroc_trajectory(folder / "e.csv", trajectory);
  const Trajectory read = read_euroc_ground_truth(folder / "e.csv");
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].timestamp, trajectory[i].timestamp, 1e-6);
    EXPECT_TRUE(read[i].T_world_camera.matrix().isApprox(trajectory[i].T_world_camera.matrix(), 1e-9));
  }
  EXPECT_EQ(detect_trajectory_format(folder / "e.csv"), TrajectoryFormat::kEuroc);
}

TEST(TrajectoryFile, CsvHasTitlesAndCommas) {
  const TemporaryFolder folder;
  write_csv_trajectory(folder / "t.csv", {{1.5, SE3d(SO3d(), {1, 2, 3})}});
  EXPECT_EQ(read_file(folder / "t.csv"), "timestamp,tx,ty,tz,qx,qy,qz,qw\n1.500000000,1,2,3,0,0,0,1\n");
}

TEST(TrajectoryFile, BadKittiAndEurocFilesAreErrors) {
  const TemporaryFolder folder;
  write_text(folder / "k.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_NE(error_of([&] { read_kitti_poses(folder / "k.txt", {0.0, 0.1}); }).find("k.txt:2"), std::string::npos);
  EXPECT_NE(error_of([&] { read_kitti_poses(folder / "k.txt", {0.0}); }).find("2 poses for 1 times"),
            std::string::npos);
  write_text(folder / "e.csv", "1.5,0,0,0,1,0,0,0\n");
  EXPECT_NE(error_of([&] { read_euroc_ground_truth(folder / "e.csv"); }).find("e.csv:1"), std::string::npos);
}

TEST(TrajectoryFile, UnknownAndEmptyFilesAreErrors) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "1 2 3\n");
  EXPECT_NE(error_of([&] { detect_trajectory_format(folder / "a.txt"); }).find("a.txt:1"), std::string::npos);
  write_text(folder / "b.txt", "# nothing\n");
  EXPECT_NE(error_of([&] { detect_trajectory_format(folder / "b.txt"); }).find("no pose"), std::string::npos);
  EXPECT_NE(error_of([&] { read_tum_trajectory(folder / "b.txt"); }).find("no pose"), std::string::npos);
}

TEST(TrajectoryFile, NumbersThatAreNotFiniteAreNotWritten) {
  const TemporaryFolder folder;
  Trajectory trajectory = sample_trajectory();
  trajectory[3].T_world_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { write_tum_trajectory(folder / "t.txt", trajectory); }).find("not finite"),
            std::string::npos);
  EXPECT_NE(error_of([&] { write_kitti_poses(folder / "t.txt", trajectory); }).find("not finite"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "t.txt"));
}

TEST(TrajectoryFile, TimesWithoutRoomInNanosecondsAreNotWritten) {
  const TemporaryFolder folder;
  const Trajectory trajectory{{1e30, SE3d()}};
  EXPECT_NE(error_of([&] { write_euroc_trajectory(folder / "t.csv", trajectory); }).find("no room in nanoseconds"),
            std::string::npos);
  write_tum_trajectory(folder / "t.txt", trajectory);
  EXPECT_EQ(read_tum_trajectory(folder / "t.txt")[0].timestamp, 1e30);
}

}  // namespace
}  // namespace ldso
