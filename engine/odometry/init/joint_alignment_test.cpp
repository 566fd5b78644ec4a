#include "odometry/init/joint_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "odometry/init/test_scene.h"
#include "odometry/selection/point_selector.h"
#include "util/hash.h"
#include "util/median.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{256, 192, 210, 205, 126.5, 97.5};

double degrees(double radians) { return radians * 180 / M_PI; }

/// How far an estimate is from the truth, whose scale it does not know.
struct Errors {
  double rotation = 0, direction = 0;  ///< [deg]
  double median_idepth = 0;            ///< Relative.
  double near_share = 0;               ///< Of the points: those within a tenth of their true inverse depth.
};

class JointAlignmentTest : public testing::Test {
 protected:
  JointAlignmentTest() {
    for (const SelectedPixel& pixel : select_gradient_pixels(first_->pyramid.levels[0], 500, 1)) {
      pixels_.emplace_back(pixel.x, pixel.y);
      truth_.push_back(1 / scene_.look(SE3d(), pixel.x, pixel.y).depth);
    }
  }

  std::shared_ptr<const PreparedFrame> second(const test::Look& look = {0.9, 6, 1.5}) const {
    return scene_.frame(1, T_second_first_.inverse(), look);
  }

  /// Inverse depths wrong by up to `spread`, direction of motion by 4 degrees, rotation by a quarter.
  JointState wrong_start(double spread) const {
    JointState state;
    state.T_second_first = SE3d(SO3d::exp({0.003, -0.002, 0.003}) * T_second_first_.rotation(),
                                SO3d::exp({0.02, 0.05, -0.05}) * T_second_first_.translation());
    state.a = -0.03;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      state.idepth.push_back(truth_[i] * (1 + spread * (2 * unit_interval(hash_of(i, 5)) - 1)));
    }
    return state;
  }

  Errors errors(const JointState& state, const std::vector<JointPointQuality>* points = nullptr) const {
    std::vector<double> ratios, off;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      if (points == nullptr || (*points)[i].visible) ratios.push_back(state.idepth[i] / truth_[i]);
    }
    std::vector<double> sorted = ratios;
    const double scale = upper_median(sorted);
    for (const double ratio : ratios) off.push_back(std::abs(ratio / scale - 1));
    const Eigen::Vector3d t = state.T_second_first.translation(), true_t = T_second_first_.translation();
    Errors result;
    result.rotation = degrees((state.T_second_first.rotation() * T_second_first_.rotation().inverse()).log().norm());
    result.direction = degrees(std::atan2(t.cross(true_t).norm(), t.dot(true_t)));
    result.near_share = static_cast<double>(std::count_if(off.begin(), off.end(), [](double x) { return x < 0.1; })) /
                        static_cast<double>(off.size());
    result.median_idepth = upper_median(off);
    return result;
  }

  ThreadPool pool_{2};
  test::Scene scene_{kCamera};
  SE3d T_second_first_{SO3d::exp({0.01, -0.02, 0.015}), {-0.22, 0.05, 0.1}};
  std::shared_ptr<const PreparedFrame> first_ = scene_.frame(0, SE3d(), {1, 0, 1.5});
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<double> truth_;
};

TEST_F(JointAlignmentTest, ConvergesToTheTrueDepthsAndPose) {
  const JointState start = wrong_start(0.2);
  const Errors before = errors(start);
  ASSERT_GT(before.rotation, 0.2);
  ASSERT_GT(before.direction, 3);
  ASSERT_GT(before.median_idepth, 0.08);
  const JointAlignment alignment(*first_, pixels_, kCamera, pool_);
  const JointFit fit = alignment.align(*second(), start, {}, 1);
  const Errors after = errors(fit.state, &fit.points);
  EXPECT_LT(after.rotation, 0.1);
  EXPECT_LT(after.direction, 0.8);
  EXPECT_LT(after.median_idepth, 0.02);
  EXPECT_GT(after.near_share, 0.9);
  EXPECT_NEAR(std::exp(fit.state.a), 0.9, 0.02);
  EXPECT_NEAR(fit.state.b, 6, 2);
}

TEST_F(JointAlignmentTest, FromTheTruthItStaysThere) {
  JointState start = wrong_start(0);
  start.T_second_first = T_second_first_;
  const JointAlignment alignment(*first_, pixels_, kCamera, pool_);
  const JointFit fit = alignment.align(*second({1, 0, 1.5}), start, {}, 1);
  const Errors after = errors(fit.state, &fit.points);
  EXPECT_LT(after.rotation, 0.1);
  EXPECT_LT(after.direction, 0.8);
  EXPECT_LT(after.median_idepth, 0.02);
  // Noise of both images, lessened by interpolation.
  EXPECT_GT(fit.noise, 1.2);
  EXPECT_LT(fit.noise, 2.5);
}

TEST_F(JointAlignmentTest, VariancesTellWhichDepthsAreUncertain) {
  const JointAlignment alignment(*first_, pixels_, kCamera, pool_);
  const JointFit fit = alignment.align(*second(), wrong_start(0.1), {}, 1);
  std::vector<double> ratios;
  int visible = 0, within_three = 0;
  for (std::size_t i = 0; i < truth_.size(); ++i) ratios.push_back(fit.state.idepth[i] / truth_[i]);
  const double scale = upper_median(ratios);
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    if (!fit.points[i].visible) continue;
    ++visible;
    const double error = fit.state.idepth[i] / scale - truth_[i];
    within_three += error * error * scale * scale < 9 * fit.points[i].idepth_variance;
    EXPECT_GT(fit.points[i].parallax, 0);
  }
  EXPECT_GT(visible, 400);
  EXPECT_GT(within_three, 0.8 * visible);
  EXPECT_GT(fit.direction_stddev, 0);
  EXPECT_LT(degrees(fit.direction_stddev), 1);
}

TEST_F(JointAlignmentTest, APriorHoldsTheBrightness) {
  JointState start = wrong_start(0.1);
  start.a = 0;
  const JointAlignment alignment(*first_, pixels_, kCamera, pool_);
  const auto frame = second({0.97, 1, 1.5});
  EXPECT_LT(alignment.align(*frame, start, {}, 1).state.a, -0.02);
  const JointFit held = alignment.align(*frame, start, {1e12, 1e12}, 1);
  EXPECT_NEAR(held.state.a, 0, 1e-4);
  EXPECT_NEAR(held.state.b, 0, 1e-4);
}

TEST_F(JointAlignmentTest, NeighbourMediansAreThoseOfTheTenNearest) {
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < 30; ++i) line.emplace_back(20 + 5 * i, 90);
  const JointAlignment alignment(*first_, line, kCamera, pool_);
  std::vector<double> values(30);
  for (std::size_t i = 0; i < 30; ++i) values[i] = static_cast<double>(i);
  values[10] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> medians = alignment.neighbour_medians(values);
  EXPECT_EQ(medians[0], 5);    // of 1 to 9
  EXPECT_EQ(medians[10], 11);  // of 5 to 9 and 11 to 15, the upper one
  EXPECT_EQ(medians[20], 21);  // of 15 to 19 and 21 to 25
  const std::vector<double> unknown(30, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(alignment.neighbour_medians(unknown)[3]));
}

TEST_F(JointAlignmentTest, SameBitsForAnyNumberOfThreads) {
  const auto frame = second();
  std::vector<JointFit> fits;
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    fits.push_back(JointAlignment(*first_, pixels_, kCamera, pool).align(*frame, wrong_start(0.2), {}, 1));
  }
  for (const JointFit& fit : fits) {
    EXPECT_EQ(fit.energy, fits[0].energy);
    EXPECT_EQ(fit.state.T_second_first.matrix(), fits[0].state.T_second_first.matrix());
    EXPECT_EQ(fit.state.idepth, fits[0].state.idepth);
  }
}

}  // namespace
}  // namespace ldso
