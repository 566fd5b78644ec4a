#include "odometry/keyframe_maker.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "odometry/test_rendered_path.h"

namespace ldso {
namespace {

constexpr int kKeyframes = 4;

class KeyframeMakerTest : public test::RenderedPathTest<12> {
 protected:
  /// The first frames of the path as keyframes, a bit away from the truth.
  Window optimized_window() {
    Window window = test::true_window(*scene_, {frames_.begin(), frames_.begin() + kKeyframes}, 14);
    test::disturb(window, 0.002, 0.001, 0, 0, 0.005, 2);
    window.camera_prior.setConstant(1e4);
    WindowOptimizer(pool_).optimize(window, 10);
    return window;
  }

  KeyframeMaker maker(const Settings& settings = {}) {
    return KeyframeMaker(settings, BrightnessPriors(settings.photometry, false), pool_, times_);
  }

  bool add(KeyframeMaker& maker, Window& window, int index) {
    return maker.add(window, frames_[static_cast<std::size_t>(index)], test::path_pose(index), {},
                     SE3d::Tangent::Zero());
  }

  ThreadPool pool_{1};
  StageTimes times_;
};

TEST_F(KeyframeMakerTest, TheNewestKeyframeGetsCandidatesAndThosePastTheMostLeave) {
  Settings settings;
  settings.keyframes.window_max = 5;
  KeyframeMaker keyframe_maker = maker(settings);
  Window window = optimized_window();
  std::vector<std::int64_t> left;
  for (int i = kKeyframes; i < 8; ++i) {
    ASSERT_TRUE(add(keyframe_maker, window, i)) << i;
    for (const FinishedKeyframe& finished : keyframe_maker.clear_up(window)) {
      left.push_back(finished.update.frame_id);
      EXPECT_EQ(finished.update.camera.fx, window.camera[0]);
    }
    EXPECT_EQ(window.keyframes.back()->id(), i);
    EXPECT_GT(window.keyframes.back()->immature.size(), 300u);
    EXPECT_LE(window.size(), 5);
    EXPECT_EQ(window.prior.b.size(), window.dim());
  }
  EXPECT_EQ(left.size() + static_cast<std::size_t>(window.size()), 8u);
}

TEST_F(KeyframeMakerTest, AKeyframeThatDoesNotFitLeavesTheWindowAsItWas) {
  Settings settings;
  settings.photometry.unknown_prior_a = std::numeric_limits<double>::quiet_NaN();
  KeyframeMaker keyframe_maker = maker(settings);
  Window window = optimized_window();
  const Window before = optimized_window();
  ASSERT_FALSE(add(keyframe_maker, window, kKeyframes));
  ASSERT_EQ(window.size(), kKeyframes);
  EXPECT_EQ(window.camera, before.camera);
  EXPECT_EQ(window.hessian, before.hessian);
  EXPECT_EQ(window.rmse, before.rmse);
  EXPECT_EQ(window.prior.b.size(), window.dim());
  for (int k = 0; k < kKeyframes; ++k) {
    const Keyframe &keyframe = *window.keyframes[k], &expected = *before.keyframes[k];
    EXPECT_EQ(keyframe.state.T_c_w().matrix(), expected.state.T_c_w().matrix()) << k;
    ASSERT_EQ(keyframe.points.size(), expected.points.size());
    for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
      EXPECT_EQ(keyframe.points[i].idepth, expected.points[i].idepth);
      for (const PointResidual& residual : keyframe.points[i].residuals) EXPECT_LT(residual.target->index, kKeyframes);
    }
  }
}

}  // namespace
}  // namespace ldso
