#include "odometry/init/initializer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "ldso/error.h"
#include "odometry/init/test_scene.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{256, 192, 210, 205, 126.5, 97.5};

SE3d pose(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  return SE3d(SO3d::exp(rotation), translation);
}

double degrees(double radians) { return radians * 180 / M_PI; }

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

/// Correlation of estimated with true inverse depths over the good points, and the median relative error
/// once the common scale is removed.
struct DepthScore {
  int good = 0;
  double mean = 0;
  double correlation = 0;
  double median_error = 0;
};

DepthScore score(const test::Scene& scene, const SE3d& T_world_first, const Initialization& result) {
  std::vector<double> estimate, truth;
  for (const InitialPoint& point : result.points) {
    if (!point.is_good) continue;
    estimate.push_back(point.idepth);
    truth.push_back(1 / scene.look(T_world_first, point.u, point.v).depth);
  }
  const auto n = static_cast<Eigen::Index>(estimate.size());
  const Eigen::Map<const Eigen::ArrayXd> e(estimate.data(), n), t(truth.data(), n);
  const Eigen::ArrayXd de = e - e.mean(), dt = t - t.mean();
  const double scale = (e * t).sum() / (t * t).sum();
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < n; ++i) errors.push_back(std::abs(e[i] / (scale * t[i]) - 1));
  std::nth_element(errors.begin(), errors.begin() + n / 2, errors.end());
  return {static_cast<int>(n), e.mean(), (de * dt).sum() / std::sqrt((de * de).sum() * (dt * dt).sum()),
          errors[static_cast<std::size_t>(n / 2)]};
}

class InitializerTest : public ::testing::Test {
 protected:
  using Motion = std::function<SE3d(int)>;  // T_world_camera of frame k

  /// Adds frames until it is ready; the number of the frame, or -1.
  int run(Initializer& initializer, const Motion& motion, int frames, const test::Look& look = {0.97, 2, 1.5}) {
    for (int k = 0; k < frames; ++k) {
      const auto status = initializer.add(scene_.frame(k, motion(k), k == 0 ? test::Look{1, 0, 1.5} : look));
      if (status == Initializer::Status::kReady) return k;
    }
    return -1;
  }

  void expect_right(const Initializer& initializer, const Motion& motion) {
    const Initialization& result = initializer.result();
    const SE3d T_world_first = motion(static_cast<int>(result.first_frame_id));
    const SE3d T_true = motion(static_cast<int>(result.current_frame_id)).inverse() * T_world_first;
    EXPECT_LT(angle_between(result.T_current_first.translation(), T_true.translation()), 1.0);
    EXPECT_LT(degrees((result.T_current_first.rotation() * T_true.rotation().inverse()).log().norm()), 0.1);
    const DepthScore depths = score(scene_, T_world_first, result);
    EXPECT_GT(depths.good, 300);
    EXPECT_NEAR(depths.mean, 1.0, 1e-4);
    EXPECT_GT(depths.correlation, 0.9);
    EXPECT_LT(depths.median_error, 0.05);
    EXPECT_EQ(initializer.first_frame()->id, result.first_frame_id);
    EXPECT_EQ(initializer.newest_frame()->id, result.current_frame_id);
    EXPECT_TRUE(initializer.reason().empty());
  }

  ThreadPool pool_{2};
  test::Scene scene_{kCamera};
  Initializer initializer_{kCamera, {}, {}, pool_};
};

TEST_F(InitializerTest, StartsFromSidewaysMotion) {
  const Motion motion = [](int k) { return pose({0.03 * k, 0.004 * k, 0}, {0.001 * k, -0.004 * k, 0.002 * k}); };
  const int ready = run(initializer_, motion, 12);
  ASSERT_GE(ready, 1) << initializer_.reason();
  expect_right(initializer_, motion);
  EXPECT_NEAR(std::exp(initializer_.result().a), 0.97, 0.01);
  EXPECT_NEAR(initializer_.result().b, 2, 1.5);
}

TEST_F(InitializerTest, StartsFromForwardMotion) {
  const Motion motion = [](int k) { return pose({0.01 * k, 0, 0.12 * k}, {0, 0.002 * k, 0}); };
  ASSERT_GE(run(initializer_, motion, 10), 1) << initializer_.reason();
  expect_right(initializer_, motion);
}

TEST_F(InitializerTest, StartsFromBackwardMotion) {
  const Motion motion = [](int k) { return pose({0, 0, -0.12 * k}); };
  ASSERT_GE(run(initializer_, motion, 10), 1) << initializer_.reason();
  expect_right(initializer_, motion);
}

TEST_F(InitializerTest, StartsWhileTurningFast) {
  const Motion motion = [](int k) { return pose({0.05 * k, 0, 0.05 * k}, {0, 0.06 * k, 0}); };
  ASSERT_GE(run(initializer_, motion, 10), 1) << initializer_.reason();
  expect_right(initializer_, motion);
}

TEST_F(InitializerTest, FollowsBrightnessChanges) {
  const Motion motion = [](int k) { return pose({0.04 * k, 0.01 * k, 0.02 * k}); };
  ASSERT_GE(run(initializer_, motion, 10, {0.7, 20, 1.5}), 1) << initializer_.reason();
  expect_right(initializer_, motion);
  EXPECT_NEAR(std::exp(initializer_.result().a), 0.7, 0.01);
  EXPECT_NEAR(initializer_.result().b, 20, 1.5);
}

TEST_F(InitializerTest, WaitsWhileStandingStill) {
  const Motion motion = [](int) { return SE3d(); };
  EXPECT_EQ(run(initializer_, motion, 20), -1);
  EXPECT_EQ(initializer_.first_frame()->id, 0);
  EXPECT_NE(initializer_.reason().find("waiting for parallax"), std::string::npos) << initializer_.reason();
}

TEST_F(InitializerTest, WaitsWhileOnlyTurning) {
  const Motion motion = [](int k) { return pose({0, 0, 0}, {0.004 * k, -0.012 * k, 0.01 * k}); };
  EXPECT_EQ(run(initializer_, motion, 20), -1);
  EXPECT_FALSE(initializer_.reason().empty());
}

TEST_F(InitializerTest, StartsAfterHavingTurned) {
  const Motion motion = [](int k) { return pose({0, 0.03 * std::max(0, k - 10), 0}, {0, 0.01 * std::min(k, 10), 0}); };
  const int ready = run(initializer_, motion, 30);
  ASSERT_GT(ready, 10) << initializer_.reason();
  expect_right(initializer_, motion);
}

TEST_F(InitializerTest, TakesNewFirstFrameWhenTheOldOneIsLost) {
  // Half way it looks elsewhere from one frame to the next.
  const Motion motion = [](int k) {
    return k < 3 ? pose({0.001 * k, 0, 0}, {0.9, 0.3, 0}) : pose({0.03 * (k - 3), 0, 0});
  };
  std::vector<Initializer::Status> statuses;
  std::string reason;
  for (int k = 0; k < 16; ++k) {
    statuses.push_back(initializer_.add(scene_.frame(k, motion(k), {1, 0, 1.5})));
    if (statuses.back() == Initializer::Status::kRestarted) reason = initializer_.reason();
    if (statuses.back() == Initializer::Status::kReady) break;
  }
  ASSERT_EQ(statuses.back(), Initializer::Status::kReady) << initializer_.reason();
  EXPECT_EQ(statuses[3], Initializer::Status::kRestarted);
  EXPECT_NE(reason.find("restarted"), std::string::npos) << reason;
  EXPECT_EQ(initializer_.result().first_frame_id, 3);
  expect_right(initializer_, motion);
}

TEST_F(InitializerTest, TakesNewFirstFrameAfterTooLongAWait) {
  InitializerSettings settings;
  settings.max_frames = 5;
  Initializer initializer(kCamera, settings, {}, pool_);
  const Motion motion = [](int k) { return pose({0, 0, 0}, {0, 0.01 * k, 0}); };
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(initializer.add(scene_.frame(k, motion(k))), Initializer::Status::kWaiting);
  }
  EXPECT_EQ(initializer.add(scene_.frame(5, motion(5))), Initializer::Status::kRestarted);
  EXPECT_EQ(initializer.first_frame()->id, 5);
}

TEST_F(InitializerTest, SameBitsForAnyNumberOfThreads) {
  std::vector<std::shared_ptr<const PreparedFrame>> frames;
  for (int k = 0; k < 8; ++k) {
    frames.push_back(scene_.frame(k, pose({0.03 * k, 0.004 * k, 0.02 * k}, {0, 0.004 * k, 0}), {1, 0, 1.5}));
  }
  std::vector<Initialization> results;
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    Initializer initializer(kCamera, {}, {}, pool);
    auto status = Initializer::Status::kWaiting;
    for (std::size_t k = 0; k < frames.size() && status != Initializer::Status::kReady; ++k) {
      status = initializer.add(frames[k]);
    }
    ASSERT_EQ(status, Initializer::Status::kReady) << initializer.reason();
    results.push_back(initializer.result());
  }
  for (const Initialization& other : results) {
    EXPECT_EQ(other.T_current_first.matrix(), results[0].T_current_first.matrix());
    EXPECT_EQ(other.a, results[0].a);
    ASSERT_EQ(other.points.size(), results[0].points.size());
    for (std::size_t i = 0; i < other.points.size(); ++i) {
      EXPECT_EQ(other.points[i].idepth, results[0].points[i].idepth);
    }
  }
}

TEST_F(InitializerTest, RefusesFramesOfAnotherSize) {
  PinholeIntrinsics other = kCamera;
  other.width = 160;
  Initializer initializer(other, {}, {}, pool_);
  EXPECT_THROW(initializer.add(scene_.frame(0, SE3d())), Error);
}

TEST_F(InitializerTest, SaysSoWhenThereIsNoTexture) {
  auto blank = std::make_shared<PreparedFrame>();
  const Image<float> grey(kCamera.width, kCamera.height, 100.0f);
  blank->pyramid = build_pyramid(grey.view());
  initializer_.add(blank);
  EXPECT_EQ(initializer_.add(blank), Initializer::Status::kRestarted);
  EXPECT_NE(initializer_.reason().find("texture"), std::string::npos) << initializer_.reason();
}

}  // namespace
}  // namespace ldso
