#include "odometry/init/patch_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "odometry/init/test_scene.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{256, 192, 210, 205, 126.5, 97.5};

class PatchTrackerTest : public ::testing::Test {
 protected:
  std::vector<Eigen::Vector2d> grid() const {
    std::vector<Eigen::Vector2d> pixels;
    for (int y = 30; y < 165; y += 15) {
      for (int x = 30; x < 230; x += 15) pixels.emplace_back(x, y);
    }
    return pixels;
  }

  Eigen::Vector2d truth(const SE3d& T_world_camera, const Eigen::Vector2d& p) const {
    const double depth = scene_.look(SE3d(), p.x(), p.y()).depth;
    const Eigen::Vector3d q =
        T_world_camera.inverse() *
        Eigen::Vector3d((p.x() - kCamera.cx) / kCamera.fx * depth, (p.y() - kCamera.cy) / kCamera.fy * depth, depth);
    return {kCamera.fx * q.x() / q.z() + kCamera.cx, kCamera.fy * q.y() / q.z() + kCamera.cy};
  }

  /// Whether the patch around a pixel of the first camera shows one plane: elsewhere it has more than one motion.
  bool on_one_plane(const Eigen::Vector2d& p) const {
    const int plane = scene_.look(SE3d(), p.x(), p.y()).plane;
    for (const int dy : {-4, 0, 4}) {
      for (const int dx : {-4, 0, 4}) {
        if (scene_.look(SE3d(), p.x() + dx, p.y() + dy).plane != plane) return false;
      }
    }
    return true;
  }

  ThreadPool pool_{2};
  test::Scene scene_{kCamera};
};

TEST_F(PatchTrackerTest, FindsPatchesThatMovedFar) {
  const SE3d T(SO3d::exp({0.01, -0.05, 0.01}), Eigen::Vector3d(0.05, 0.02, 0.02));
  const auto first = scene_.frame(0, SE3d(), {1, 0, 1});
  const auto second = scene_.frame(1, T, {0.9, 5, 1});
  const std::vector<Eigen::Vector2d> pixels = grid();
  const PatchTracker tracker(*first, pixels, pool_);
  std::vector<PatchPrediction> predictions;
  for (const auto& p : pixels) predictions.emplace_back().starts = {p};
  const std::vector<PatchMatch> matches = tracker.track(*second, predictions, {0.9, 5}, pool_);
  int all = 0, found = 0, right = 0, as_expected = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!on_one_plane(pixels[i])) continue;
    ++all;
    if (!matches[i].found) continue;
    ++found;
    const Eigen::Vector2d error = matches[i].position - truth(T, pixels[i]);
    right += error.norm() < 0.5 ? 1 : 0;
    EXPECT_GT(matches[i].covariance.determinant(), 0);
    // The covariance knows of the misfit, not of the warp and the gain that were taken for granted.
    as_expected += error.dot(matches[i].covariance.inverse() * error) < 6 * 6 ? 1 : 0;
  }
  ASSERT_GT(all, 90);
  EXPECT_GT(found, 0.9 * all);
  EXPECT_GT(right, 0.9 * found);
  EXPECT_GT(as_expected, 0.98 * found);
}

TEST_F(PatchTrackerTest, PatchesOutsideAreNotFound) {
  const auto frame = scene_.frame(0, SE3d());
  const std::vector<Eigen::Vector2d> pixels = {{1, 1}, {130, 100}, {254, 190}};
  const PatchTracker tracker(*frame, pixels, pool_);
  std::vector<PatchPrediction> predictions(3);
  predictions[0].starts = {pixels[0]};
  predictions[1].starts = {{-50, 20}};
  for (const PatchMatch& match : tracker.track(*frame, predictions, {}, pool_)) EXPECT_FALSE(match.found);
}

}  // namespace
}  // namespace ldso
