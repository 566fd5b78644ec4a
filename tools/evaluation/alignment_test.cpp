#include "evaluation/alignment.h"

#include <gtest/gtest.h>

#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

void expect_near(const Sim3d& a, const Sim3d& b, double tolerance) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), tolerance) << a.matrix() << "\n\n" << b.matrix();
}

TEST(Alignment, FindsTheSimilarity) {
  const Trajectory estimate = winding_trajectory(40);
  const Trajectory truth = transformed(some_similarity(), estimate);
  expect_near(align_pairs(estimate, truth, associate_by_index(estimate, truth), AlignmentMode::kSim3),
              some_similarity(), 1e-11);
}

TEST(Alignment, OfAStraightDriveUsesTheOrientations) {
  const Trajectory estimate = straight_trajectory(50);
  const Trajectory truth = transformed(some_similarity(), estimate);
  expect_near(align_pairs(estimate, truth, associate_by_index(estimate, truth), AlignmentMode::kSim3),
              some_similarity(), 1e-9);
}

TEST(Alignment, OfACameraThatStandsStillIsAnError) {
  const Trajectory still(5, StampedPose{});
  EXPECT_THROW(align_pairs(still, still, associate_by_index(still, still), AlignmentMode::kSim3), Error);
}

TEST(Alignment, ScalesPositionsButNotCameras) {
  const SE3d T = apply_alignment(some_similarity(), SE3d(SO3d(), Eigen::Vector3d(1, 2, 3)));
  EXPECT_NEAR(T.rotation_matrix().determinant(), 1.0, 1e-12);
  EXPECT_LT((T.translation() - some_similarity() * Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(Alignment, NamesAreReadAsTheyAreWritten) {
  for (const auto mode : {AlignmentMode::kNone, AlignmentMode::kScale, AlignmentMode::kSe3, AlignmentMode::kSim3}) {
    EXPECT_EQ(parse_alignment_mode(to_string(mode)), mode);
  }
  EXPECT_THROW(parse_alignment_mode("affine"), Error);
}

}  // namespace
}  // namespace ldso
