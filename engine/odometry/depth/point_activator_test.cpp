#include "odometry/depth/point_activator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "odometry/depth/epipolar_tracer.h"
#include "odometry/residual/photometric_residual.h"
#include "odometry/test_rendered_path.h"

namespace ldso {
namespace {

constexpr int kFrames = 4;

class PointActivatorTest : public test::RenderedPathTest<kFrames> {
 protected:
  /// Keyframes at the truth; all but the newest have immature points that the later ones have traced.
  static Window traced_window(int spacing) {
    Window window = test::empty_window(scene_->camera());
    const EpipolarTracer tracer(TracingSettings{}, 320, 240);
    for (int i = 0; i < kFrames; ++i) {
      Keyframe& keyframe = test::add_keyframe(window, frames_[i], test::path_pose(i));
      for (const auto& host : window.keyframes) {
        if (host.get() == &keyframe) continue;
        const PatternWarp warp =
            make_warp(test::path_pose(i) * test::path_pose(host->index).inverse(), window.camera, {}, keyframe.image());
        for (ImmaturePoint& point : host->immature) tracer.trace(point, warp);
      }
      for (int v = 10; v < 230; v += spacing) {
        for (int u = 10; u < 310; u += spacing) {
          ImmaturePoint point;
          make_immature_point(keyframe.image(), static_cast<float>(u), static_cast<float>(v), point);
          if (point.gxx + point.gyy > 8 * 16) keyframe.immature.push_back(point);
        }
      }
    }
    return window;
  }

  static int immature_count(const Window& window) {
    int count = 0;
    for (const auto& keyframe : window.keyframes) count += static_cast<int>(keyframe->immature.size());
    return count;
  }

  ThreadPool pool_{1};
  TracingSettings tracing_;
  WindowSettings settings_;
};

TEST_F(PointActivatorTest, ActivePointsHaveTheTrueInverseDepth) {
  Window window = traced_window(9);
  const int immature = immature_count(window);
  PointActivator activator(tracing_, settings_, pool_);
  const int activated = activator.activate(window);
  EXPECT_GT(activated, immature / 4);
  std::vector<double> errors;
  int active = 0;
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      ++active;
      EXPECT_GT(point.idepth_hessian, tracing_.least_idepth_hessian);
      ASSERT_FALSE(point.residuals.empty());
      for (const PointResidual& r : point.residuals) EXPECT_NE(r.target, host.get());
      errors.push_back(std::abs(point.idepth / scene_->idepth(test::path_pose(host->index), point.u, point.v) - 1));
    }
  }
  EXPECT_EQ(active, activated);
  EXPECT_TRUE(window.keyframes.back()->points.empty());
  EXPECT_FALSE(window.keyframes.back()->immature.empty());
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.005);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.04);
  // Who became active is no longer immature.
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      const bool still = std::any_of(host->immature.begin(), host->immature.end(),
                                     [&](const ImmaturePoint& p) { return p.u == point.u && p.v == point.v; });
      EXPECT_FALSE(still);
    }
  }
}

TEST_F(PointActivatorTest, PointsKeepTheirDistance) {
  Window window = traced_window(3);
  settings_.active_points = 300;
  PointActivator activator(tracing_, settings_, pool_);
  activator.activate(window);
  const FramePairs pairs(window);
  std::vector<Eigen::Vector2d> pixels;
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      const SE3d T = window.keyframes.back()->state.T_c_w() * host->state.T_c_w().inverse();
      const Eigen::Vector3d ray((point.u - window.camera[2]) / window.camera[0],
                                (point.v - window.camera[3]) / window.camera[1], 1);
      const Eigen::Vector3d p = T * Eigen::Vector3d(ray / point.idepth);
      pixels.emplace_back(window.camera[0] * p.x() / p.z() + window.camera[2],
                          window.camera[1] * p.y() / p.z() + window.camera[3]);
    }
  }
  ASSERT_GT(pixels.size(), 200u);
  // They were spaced where tracing had put them (within a pixel), by more than two pixels.
  int near = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) near += (pixels[i] - pixels[j]).norm() < 1.5 ? 1 : 0;
  }
  EXPECT_LT(near, 0.02 * static_cast<double>(pixels.size()));
}

TEST_F(PointActivatorTest, SteersTheNumberOfActivePoints) {
  for (const int wanted : {250, 600}) {
    SCOPED_TRACE(testing::Message() << wanted << " wanted");
    settings_.active_points = wanted;
    PointActivator activator(tracing_, settings_, pool_);
    Window window = traced_window(4);
    std::vector<std::vector<ImmaturePoint>> candidates;
    for (const auto& keyframe : window.keyframes) candidates.push_back(keyframe->immature);
    for (int round = 0; round < 20; ++round) {
      // With every keyframe a fifth of the points leaves and there are candidates anew; what stayed is steered.
      int active = 0;
      for (const auto& keyframe : window.keyframes) {
        int index = round;
        std::erase_if(keyframe->points, [&](const ActivePoint&) { return index++ % 5 == 0; });
        active += static_cast<int>(keyframe->points.size());
        keyframe->immature = candidates[static_cast<std::size_t>(keyframe->index)];
      }
      activator.activate(window);
      if (round < 12) continue;
      EXPECT_GT(active, 0.8 * wanted) << "round " << round;
      EXPECT_LT(active, 1.25 * wanted) << "round " << round;
    }
  }
}

TEST_F(PointActivatorTest, PointsThatCannotBecomeActiveAreRemoved) {
  Window window = traced_window(12);
  Keyframe& host = *window.keyframes[0];
  ASSERT_GT(host.immature.size(), 30u);
  host.immature.resize(30);
  for (std::size_t i = 0; i < 30; ++i) {
    ImmaturePoint& point = host.immature[i];
    if (i < 10) point.status = TraceStatus::kOutlier;
    if (i >= 10 && i < 20) {
      point.status = TraceStatus::kOutOfView;
      point.idepth_max = std::numeric_limits<float>::quiet_NaN();
    }
    if (i >= 20) {  // Not ready, but not hopeless.
      point.status = TraceStatus::kGood;
      point.interval_px = 50;
    }
  }
  PointActivator activator(tracing_, settings_, pool_);
  activator.activate(window);
  EXPECT_TRUE(host.points.empty());
  for (const ImmaturePoint& point : host.immature) {
    EXPECT_NE(point.status, TraceStatus::kOutOfView);
    EXPECT_EQ(point.interval_px, 50);
  }
  EXPECT_EQ(host.immature.size(), 10u);
}

TEST_F(PointActivatorTest, WrongIntervalsAreRefinedOrRejected) {
  Window window = traced_window(12);
  for (auto& keyframe : window.keyframes) {
    for (ImmaturePoint& point : keyframe->immature) {
      if (!std::isfinite(point.idepth_max)) continue;
      // The truth at the border of the interval: 3 % off.
      const auto truth = static_cast<float>(scene_->idepth(test::path_pose(keyframe->index), point.u, point.v));
      point.idepth_min = truth;
      point.idepth_max = 1.06f * truth;
    }
  }
  PointActivator activator(tracing_, settings_, pool_);
  ASSERT_GT(activator.activate(window), 100);
  std::vector<double> errors;
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      errors.push_back(std::abs(point.idepth / scene_->idepth(test::path_pose(host->index), point.u, point.v) - 1));
    }
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.005);
}

/// As many keyframes as the settings allow.
TEST_F(PointActivatorTest, InALargeWindowTheNewestKeyframesAreTargetsToo) {
  Window window = traced_window(12);
  constexpr int kMany = 51;
  while (window.size() < kMany) test::add_keyframe(window, frames_[kFrames - 1], test::path_pose(kFrames - 1));
  PointActivator activator(tracing_, settings_, pool_);
  ASSERT_GT(activator.activate(window), 50);
  int in_newest = 0, points = 0;
  for (const auto& host : window.keyframes) {
    for (const ActivePoint& point : host->points) {
      ++points;
      for (const PointResidual& r : point.residuals) in_newest += r.target == window.keyframes.back().get() ? 1 : 0;
    }
  }
  EXPECT_GT(in_newest, points / 2);
}

TEST_F(PointActivatorTest, ThreadsDoNotChangeABit) {
  Window one = traced_window(9), other = traced_window(9);
  ThreadPool three(3);
  EXPECT_EQ(PointActivator(tracing_, settings_, pool_).activate(one),
            PointActivator(tracing_, settings_, three).activate(other));
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_EQ(one.keyframes[i]->points.size(), other.keyframes[i]->points.size());
    for (std::size_t p = 0; p < one.keyframes[i]->points.size(); ++p) {
      EXPECT_EQ(one.keyframes[i]->points[p].idepth, other.keyframes[i]->points[p].idepth);
    }
  }
}

}  // namespace
}  // namespace ldso
