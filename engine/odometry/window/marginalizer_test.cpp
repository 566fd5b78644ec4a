#include "odometry/window/marginalizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "odometry/test_rendered_path.h"
#include "odometry/window/window_optimizer.h"

namespace ldso {
namespace {

class MarginalizerTest : public test::RenderedPathTest<4> {
 protected:
  MarginalizerTest() : window_(test::true_window(*scene_, frames_, 20)) {
    for (auto& keyframe : window_.keyframes) {
      for (ActivePoint& point : keyframe->points) point.good_residuals = 4;
    }
    test::disturb(window_, 0.002, 0.001, 0, 0, 0.01, 2);
    WindowOptimizer(pool_).optimize(window_, 4);
    // optimize() has not built normal equations at its result: that gives the points their Hessians.
    const auto chunks = chunk_points(window_, [](const ActivePoint&) { return true; });
    NormalEquationsBuilder(pool_).build(window_, FramePairs(window_), chunks, 0);
  }

  WindowSettings settings_;
  ThreadPool pool_{1};
  Window window_;
};

TEST_F(MarginalizerTest, NothingLeavesWithoutAReason) {
  std::size_t before = 0, after = 0;
  for (auto& keyframe : window_.keyframes) {
    for (ActivePoint& point : keyframe->points) point.newest_states[0] = ResidualState::kInlier;
    std::erase_if(keyframe->points, [](const ActivePoint& p) { return p.residuals.empty(); });
    before += keyframe->points.size();
  }
  Marginalizer marginalizer(settings_, pool_);
  marginalizer.remove_points(window_);
  EXPECT_TRUE(marginalizer.remove_keyframes(window_).empty());
  for (auto& keyframe : window_.keyframes) after += keyframe->points.size();
  EXPECT_EQ(before, after);
  EXPECT_EQ(window_.prior.H.norm(), 0);
}

TEST_F(MarginalizerTest, ThePriorIsTheWeightedSchurComplementOfTheLeavingPoints) {
  Keyframe& leaving = *window_.keyframes[1];
  leaving.leaving = true;
  for (auto& keyframe : window_.keyframes) {
    for (ActivePoint& point : keyframe->points) point.newest_states[0] = ResidualState::kInlier;
  }
  // Expected: built from the points of the leaving keyframe alone.
  const auto reliable = [&](const ActivePoint& p) {
    return p.residuals.size() >= 3 && p.idepth_hessian > settings_.least_idepth_hessian && p.idepth > 0;
  };
  const auto first = leaving.points.data(), last = first + leaving.points.size();
  const auto chunks =
      chunk_points(window_, [&](const ActivePoint& p) { return &p >= first && &p < last && reliable(p); });
  ASSERT_FALSE(chunks.empty());
  std::size_t expected_points = 0;
  for (const PointChunk& chunk : chunks) expected_points += chunk.points.size();
  ASSERT_GT(expected_points, 20u);
  const NormalEquations equations = NormalEquationsBuilder(pool_).build(window_, FramePairs(window_), chunks, 0);
  const std::size_t all = leaving.points.size();

  Marginalizer marginalizer(settings_, pool_);
  marginalizer.remove_points(window_);
  EXPECT_TRUE(leaving.points.empty());
  EXPECT_EQ(leaving.finished.size(), expected_points);
  EXPECT_EQ(leaving.dropped, static_cast<int>(all - expected_points));
  EXPECT_TRUE(leaving.in_prior);
  const Eigen::MatrixXd H = settings_.marginalization_weight * (equations.H - equations.H_sc);
  const Eigen::VectorXd b = settings_.marginalization_weight * (equations.b - equations.b_sc);
  EXPECT_LT((window_.prior.H - H).norm(), 1e-6 * H.norm());
  EXPECT_LT((window_.prior.gradient(window_.delta()) - b).norm(), 1e-6 * b.norm());

  WindowPrior reference = window_.prior;
  reference.marginalize(Window::offset(1), kFrameDof, FrameVector::Zero(), FrameVector::Zero());
  const std::int64_t id = leaving.id();
  const SE3d T_w_c = leaving.state.T_c_w().inverse();
  const std::vector<FinishedKeyframe> updates = marginalizer.remove_keyframes(window_);
  ASSERT_EQ(updates.size(), 1u);
  EXPECT_EQ(updates[0].update.frame_id, id);
  EXPECT_EQ(updates[0].update.points.size(), expected_points);
  EXPECT_LT((updates[0].update.T_world_camera * T_w_c.inverse()).log().norm(), 1e-12);
  EXPECT_LT((window_.prior.H - reference.H).norm(), 1e-9 * reference.H.norm());
  ASSERT_EQ(window_.size(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(window_.keyframes[i]->index, i);
    for (const ActivePoint& point : window_.keyframes[i]->points) {
      for (const PointResidual& r : point.residuals) {
        EXPECT_TRUE(std::any_of(window_.keyframes.begin(), window_.keyframes.end(),
                                [&](const auto& k) { return k.get() == r.target; }));
      }
    }
  }
  for (const MapPoint& point : updates[0].update.points) {
    EXPECT_GT(point.idepth, 0);
    EXPECT_GT(point.idepth_stddev, 0);
    EXPECT_LT(point.idepth_stddev, std::sqrt(window_.residual_variance() / settings_.least_idepth_hessian));
  }
}

TEST_F(MarginalizerTest, PointsOutOfTheNewestViewLeave) {
  Keyframe& host = *window_.keyframes[0];
  for (auto& keyframe : window_.keyframes) {
    for (ActivePoint& point : keyframe->points) point.newest_states[0] = ResidualState::kInlier;
  }
  const std::size_t before = host.points.size();
  for (std::size_t i = 0; i < 12; ++i) host.points[i].newest_states[0] = ResidualState::kOutOfView;
  Marginalizer(settings_, pool_).remove_points(window_);
  EXPECT_LE(host.points.size(), before - 12);
  for (const ActivePoint& point : host.points) EXPECT_EQ(point.newest_states[0], ResidualState::kInlier);
}

TEST_F(MarginalizerTest, WeakPointsAreDroppedWithoutATrace) {
  for (auto& keyframe : window_.keyframes) {
    for (ActivePoint& point : keyframe->points) {
      point.newest_states[0] = ResidualState::kOutOfView;
      point.idepth_hessian = 40;
    }
  }
  Marginalizer(settings_, pool_).remove_points(window_);
  for (auto& keyframe : window_.keyframes) {
    EXPECT_TRUE(keyframe->points.empty());
    EXPECT_TRUE(keyframe->finished.empty());
    EXPECT_GT(keyframe->dropped, 0);
    EXPECT_FALSE(keyframe->in_prior);
  }
  EXPECT_EQ(window_.prior.H.norm(), 0);
}

TEST_F(MarginalizerTest, KeyframesAtTheEndBringTheirActivePoints) {
  const std::vector<FinishedKeyframe> all = finish_all(window_);
  ASSERT_EQ(all.size(), window_.keyframes.size());
  EXPECT_GT(all[0].update.points.size(), 50u);
  EXPECT_EQ(all[0].update.frame_id, 0);
  EXPECT_EQ(all[0].update.constraints.size(), all.size() - 1);
  EXPECT_TRUE(all.back().update.constraints.empty());
}

}  // namespace
}  // namespace ldso
