#include "odometry/window/relative_pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "odometry/test_rendered_path.h"
#include "odometry/window/finished_keyframe.h"
#include "odometry/window/window_optimizer.h"

namespace ldso {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// By which the variance is larger than residuals counted as independent would make it.
constexpr double kCorrelation = 8;

double least_eigenvalue(const Eigen::MatrixXd& C) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Keyframes on a path, without images' information.
Window bare_window(int keyframes) {
  Window window = test::empty_window(test::SyntheticScene::small_camera());
  for (int i = 0; i < keyframes; ++i) {
    auto frame = std::make_shared<PreparedFrame>();
    frame->id = 10 * i;
    frame->timestamp = i;
    test::add_keyframe(window, frame, test::path_pose(2 * i));
  }
  return window;
}

SE3d relative_pose(const Window& window, int i, int j) {
  return window.keyframes[i]->state.T_c_w() * window.keyframes[j]->state.T_c_w().inverse();
}

/// The error of T_i_j, to the left of it, by those of the keyframes' poses.
Eigen::MatrixXd relative_jacobian(const Window& window, int i, int j) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, window.dim());
  J.middleCols<6>(Window::offset(i)).setIdentity();
  J.middleCols<6>(Window::offset(j)) = -relative_pose(window, i, j).adjoint();
  return J;
}

/// What a chain of keyframes knows of itself, all of it independent and none of it of the scale: the rotation from each
/// to the next, the direction of its translation, and the logarithm of the length of each step over that of the last.
struct ChainInformation {
  double rotation_stddev = 0.003;
  double across_stddev = 0.02;
  double log_ratio_stddev = 0.01;
};

Eigen::MatrixXd chain_hessian(const Window& window, const ChainInformation& known) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(window.dim(), window.dim());
  H.topLeftCorner<kCameraDof, kCameraDof>().setIdentity();
  const auto add = [&](const Eigen::MatrixXd& J, double stddev) { H += J.transpose() * J / (stddev * stddev); };
  const auto along = [&](int i) -> Eigen::MatrixXd {
    const Eigen::Vector3d t = relative_pose(window, i, i + 1).translation();
    return t.transpose() * relative_jacobian(window, i, i + 1).topRows(3) / t.squaredNorm();
  };
  for (int i = 0; i < window.size(); ++i) {
    H.diagonal().segment<2>(Window::offset(i) + 6).array() += 100;  // Brightness.
    if (i + 1 == window.size()) break;
    const Eigen::MatrixXd J = relative_jacobian(window, i, i + 1);
    const Eigen::Vector3d t = relative_pose(window, i, i + 1).translation().normalized();
    add(J.bottomRows(3), known.rotation_stddev);
    add((Eigen::Matrix3d::Identity() - t * t.transpose()) * J.topRows(3), known.across_stddev);
    if (i > 0) add(along(i) - along(i - 1), known.log_ratio_stddev);
  }
  return H;
}

TEST(RelativePoseCovarianceTest, GivesBackWhatTheHessianKnows) {
  Window window = bare_window(4);
  const ChainInformation known;
  window.hessian = chain_hessian(window, known);
  window.rmse = 1.5;
  const RelativePoseCovariance covariance(window);
  const double unit = kCorrelation * 1.5 * 1.5;
  const double rotation = unit * known.rotation_stddev * known.rotation_stddev;
  for (int i = 0; i + 1 < 4; ++i) {
    const Sim3d::Jacobian C = covariance(i, i + 1);
    EXPECT_LT((C.block<3, 3>(3, 3) - rotation * Eigen::Matrix3d::Identity()).norm(), 1e-4 * rotation);
    const Eigen::Vector3d t = relative_pose(window, i, i + 1).translation();
    const Eigen::Vector3d across = t.cross(Eigen::Vector3d(1, 2, 3)).normalized();
    const double variance = across.dot(C.topLeftCorner<3, 3>() * across);
    EXPECT_NEAR(variance, unit * known.across_stddev * known.across_stddev, 1e-3 * variance);
  }
  // Rotations of the chain add up.
  EXPECT_LT((covariance(0, 3).block<3, 3>(3, 3) - 3 * rotation * Eigen::Matrix3d::Identity()).norm(), 3e-4 * rotation);
}

TEST(RelativePoseCovarianceTest, GivesBackHowTheScaleWanders) {
  Window window = bare_window(3);
  ChainInformation known;
  known.log_ratio_stddev = 0.004;
  window.hessian = chain_hessian(window, known);
  window.rmse = 2;
  const RelativePoseCovariance covariance(window);
  // The newer half of three keyframes is the second step, the older half the first.
  const double expected = kCorrelation * 4 * known.log_ratio_stddev * known.log_ratio_stddev;
  EXPECT_NEAR(covariance.log_scale_variance(), expected, 1e-3 * expected);
  EXPECT_EQ(covariance(0, 1)(6, 6), covariance.log_scale_variance());
  EXPECT_EQ(covariance(0, 2)(6, 6), 2 * covariance.log_scale_variance());
  EXPECT_EQ(covariance(2, 0)(6, 6), 2 * covariance.log_scale_variance());
}

TEST(RelativePoseCovarianceTest, BothDirectionsSayTheSame) {
  Window window = bare_window(4);
  window.hessian = chain_hessian(window, {});
  window.rmse = 1;
  const RelativePoseCovariance covariance(window);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      // exp(x) T inverted is exp(-Ad(T^-1) x) T^-1.
      const Matrix6d A = relative_pose(window, j, i).adjoint();
      const Matrix6d expected = A * covariance(i, j).topLeftCorner<6, 6>() * A.transpose();
      EXPECT_LT((covariance(j, i).topLeftCorner<6, 6>() - expected).norm(), 1e-9 * expected.norm());
    }
  }
}

TEST(RelativePoseCovarianceTest, GrowsWithTheResidualsDownToALeast) {
  Window window = bare_window(3);
  window.hessian = chain_hessian(window, {});
  window.rmse = 2;
  const Sim3d::Jacobian two = RelativePoseCovariance(window)(0, 1);
  window.rmse = 4;
  const Matrix6d four = RelativePoseCovariance(window)(0, 1).topLeftCorner<6, 6>();
  const Matrix6d expected = 4 * two.topLeftCorner<6, 6>();
  EXPECT_LT((four - expected).norm(), 1e-9 * four.norm());
  window.rmse = 0;
  const Sim3d::Jacobian none = RelativePoseCovariance(window)(0, 1);
  EXPECT_GT(none(3, 3), 0);
  EXPECT_LT(none(3, 3), two(3, 3) / 4);
}

TEST(RelativePoseCovarianceTest, WindowsThatWereNotOptimizedKnowNothing) {
  Window window = bare_window(3);
  window.hessian = Eigen::MatrixXd::Identity(window.dim() - kFrameDof, window.dim() - kFrameDof) * 1e9;
  window.rmse = 1;
  const RelativePoseCovariance covariance(window);
  const Sim3d::Jacobian C = covariance(0, 2);
  EXPECT_GE(least_eigenvalue(C.topLeftCorner<6, 6>()), 0.5);
  EXPECT_GE(C(6, 6), covariance.log_scale_variance());
  EXPECT_NEAR(std::sqrt(covariance.log_scale_variance()), 0.1, 1e-12);
}

TEST(RelativePoseCovarianceTest, SmallWindows) {
  Window pair = bare_window(2);
  pair.hessian = chain_hessian(pair, {});
  pair.rmse = 1;
  const RelativePoseCovariance covariance(pair);
  const Sim3d::Jacobian C = covariance(0, 1);
  EXPECT_TRUE(C.allFinite());
  EXPECT_GT(C(3, 3), 0);
  // Two keyframes do not tell how their scale wanders.
  EXPECT_NEAR(std::sqrt(C(6, 6)), 0.1, 1e-12);
  Window single = bare_window(1);
  single.hessian = Eigen::MatrixXd::Identity(single.dim(), single.dim());
  EXPECT_TRUE(std::isfinite(RelativePoseCovariance(single).log_scale_variance()));
}

TEST(RelativePoseCovarianceTest, WithoutInformationItIsLargeButFinite) {
  Window window = bare_window(4);
  window.hessian = Eigen::MatrixXd::Zero(window.dim(), window.dim());
  window.rmse = 1;
  const RelativePoseCovariance covariance(window);
  const Sim3d::Jacobian C = covariance(0, 1);
  EXPECT_TRUE(C.allFinite());
  EXPECT_GE(covariance.log_scale_variance(), 0);
  EXPECT_LE(covariance.log_scale_variance(), 0.1 * 0.1 + 1e-12);
}

/// Keyframes of the tests on images.
constexpr int kFrames = 5;

/// The same on images.
class RelativePoseCovarianceOfImages : public test::RenderedPathTest<kFrames> {
 protected:
  /// A window whose world is moved by `T_new_old` and then larger by `scale`.
  Window optimized(int spacing, const SE3d& T_new_old = SE3d(), double scale = 1) {
    Window window = test::true_window(*scene_, frames_, spacing);
    test::disturb(window, 0.002, 0.001, 0, 0, 0.005, 2);
    for (auto& keyframe : window.keyframes) {
      SE3d T = keyframe->state.T_c_w() * T_new_old.inverse();
      T.translation() *= scale;
      keyframe->state = {T, keyframe->state.brightness(), FrameVector::Zero()};
      for (ActivePoint& point : keyframe->points) point.idepth /= static_cast<float>(scale);
    }
    window.camera_prior.setConstant(1e4);
    // The Hessian is that of the state before the last step: the second time that is the optimum.
    for (int i = 0; i < 2; ++i) WindowOptimizer(pool_).optimize(window, 20);
    EXPECT_EQ(window.hessian.rows(), window.dim());
    EXPECT_GT(window.rmse, 0);
    return window;
  }

  ThreadPool pool_{1};
};

TEST_F(RelativePoseCovarianceOfImages, IsACovariance) {
  const Window window = optimized(20);
  const RelativePoseCovariance covariance(window);
  for (int i = 0; i < kFrames; ++i) {
    for (int j = 0; j < kFrames; ++j) {
      if (i == j) continue;
      const Sim3d::Jacobian C = covariance(i, j);
      ASSERT_TRUE(C.allFinite());
      EXPECT_LT((C - C.transpose()).norm(), 1e-9 * C.norm());
      EXPECT_GT(least_eigenvalue(C), 0) << i << " " << j;
      // Of the order that images of 320 x 240 pixels allow.
      EXPECT_LT(std::sqrt(C.block<3, 3>(3, 3).trace()), 0.05);
      EXPECT_TRUE(C.col(6).head<6>().isZero());
    }
  }
  const auto rotation_variance = [&](int j) { return covariance(0, j).block(3, 3, 3, 3).trace(); };
  EXPECT_GT(rotation_variance(kFrames - 1), rotation_variance(1));
}

TEST_F(RelativePoseCovarianceOfImages, FallsWithTheNumberOfPoints) {
  Window few = optimized(28), many = optimized(14);
  few.rmse = many.rmse = 1;
  const RelativePoseCovariance of_few(few), of_many(many);
  for (int i = 0; i + 1 < kFrames; ++i) {
    const double ratio = of_few(i, i + 1).block<3, 3>(3, 3).trace() / of_many(i, i + 1).block<3, 3>(3, 3).trace();
    // Four times as many points.
    EXPECT_GT(ratio, 2) << i;
    EXPECT_LT(ratio, 8) << i;
  }
  EXPECT_GT(of_few.log_scale_variance(), of_many.log_scale_variance());
}

/// What is known of relative poses does not depend on where the world has its origin.
TEST_F(RelativePoseCovarianceOfImages, DoesNotDependOnTheWorldsPose) {
  Window here = optimized(24);
  Window there = optimized(24, SE3d(SO3d::exp({0.4, -1.1, 0.7}), {3, -2, 5}));
  here.rmse = there.rmse = 1;
  const RelativePoseCovariance a(here), b(there);
  for (int j = 1; j < kFrames; ++j) {
    const Sim3d::Jacobian A = a(0, j), B = b(0, j);
    EXPECT_LT((A - B).norm(), 0.02 * A.norm()) << j;
    EXPECT_LT((A - B).block(3, 3, 3, 3).norm(), 0.02 * A.block(3, 3, 3, 3).norm()) << j;
  }
  EXPECT_NEAR(b.log_scale_variance(), a.log_scale_variance(), 0.02 * a.log_scale_variance());
}

TEST_F(RelativePoseCovarianceOfImages, TranslationsAreInTheUnitOfTheMap) {
  constexpr double kScale = 3;
  Window small = optimized(24), large = optimized(24, SE3d(), kScale);
  small.rmse = large.rmse = 1;
  const RelativePoseCovariance a(small), b(large);
  for (int j = 1; j < kFrames; ++j) {
    const Sim3d::Jacobian A = a(0, j), B = b(0, j);
    EXPECT_LT((A - B).block(3, 3, 3, 3).norm(), 0.03 * A.block(3, 3, 3, 3).norm()) << j;
    // Across the direction of motion; along it the covariance depends on what is called the common scale.
    const Eigen::Vector3d t = relative_pose(small, 0, j).translation();
    const Eigen::Vector3d across = t.cross(Eigen::Vector3d(1, 2, 3)).normalized();
    const double small_variance = across.dot(A.topLeftCorner<3, 3>() * across);
    const double large_variance = across.dot(B.topLeftCorner<3, 3>() * across);
    EXPECT_NEAR(large_variance, kScale * kScale * small_variance, 0.1 * large_variance) << j;
  }
}

/// What a keyframe leaves behind.
class FinishedKeyframeTest : public testing::Test {
 protected:
  FinishedKeyframeTest() : window_(bare_window(5)) {
    window_.hessian = chain_hessian(window_, {});
    window_.rmse = 1;
    for (int i = 0; i < window_.size(); ++i) {
      window_.keyframes[i]->corners = {{10.0f + static_cast<float>(i), 20}, {30, 40}};
      MapPoint point;
      point.idepth = 1 + static_cast<float>(i);
      window_.keyframes[i]->finished = {point};
      ActivePoint weak, good;
      weak.good_residuals = kLeastGoodResiduals - 1;
      good.good_residuals = kLeastGoodResiduals;
      good.u = 33;
      good.idepth = 0.25f;
      good.idepth_hessian = 400;
      good.is_corner = true;
      window_.keyframes[i]->points = {weak, good};
    }
  }

  std::vector<std::int64_t> ids_of_constraints(const FinishedKeyframe& keyframe) const {
    std::vector<std::int64_t> ids;
    for (const KeyframeConstraint& constraint : keyframe.update.constraints) ids.push_back(constraint.keyframe_id);
    return ids;
  }

  void expect_true_constraints(const FinishedKeyframe& finished) const {
    const auto i = static_cast<int>(finished.update.frame_id / 10);
    for (const KeyframeConstraint& constraint : finished.update.constraints) {
      const auto j = static_cast<int>(constraint.keyframe_id / 10);
      EXPECT_LT((constraint.T_this_other * relative_pose(window_, i, j).inverse()).log().norm(), 1e-12);
      EXPECT_EQ(constraint.covariance, RelativePoseCovariance(window_)(i, j));
    }
  }

  Window window_;
};

TEST_F(FinishedKeyframeTest, NothingLeaves) { EXPECT_TRUE(finish_leaving(window_).empty()); }

TEST_F(FinishedKeyframeTest, ConstraintsGoToThoseThatStay) {
  window_.keyframes[1]->leaving = true;
  // The estimate, not the point of linearization.
  window_.keyframes[1]->state.delta << 0.01, -0.02, 0.01, 0.005, 0, 0.01, 0, 0;
  const std::vector<FinishedKeyframe> finished = finish_leaving(window_);
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].update.frame_id, 10);
  EXPECT_EQ(finished[0].update.timestamp, 1);
  EXPECT_EQ(ids_of_constraints(finished[0]), std::vector<std::int64_t>({0, 20, 30, 40}));
  expect_true_constraints(finished[0]);
  const SE3d T_c_w = window_.keyframes[1]->state.T_c_w();
  EXPECT_LT((finished[0].update.T_world_camera * T_c_w).log().norm(), 1e-12);
}

TEST_F(FinishedKeyframeTest, OfSeveralEachPairIsLinkedOnce) {
  window_.keyframes[0]->leaving = window_.keyframes[2]->leaving = true;
  const std::vector<FinishedKeyframe> finished = finish_leaving(window_);
  ASSERT_EQ(finished.size(), 2u);
  EXPECT_EQ(ids_of_constraints(finished[0]), std::vector<std::int64_t>({10, 20, 30, 40}));
  EXPECT_EQ(ids_of_constraints(finished[1]), std::vector<std::int64_t>({10, 30, 40}));
  for (const FinishedKeyframe& keyframe : finished) expect_true_constraints(keyframe);
}

TEST_F(FinishedKeyframeTest, AtTheEndAllLeave) {
  window_.keyframes[3]->leaving = true;
  const std::vector<FinishedKeyframe> finished = finish_all(window_);
  ASSERT_EQ(finished.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(finished[i].update.frame_id, 10 * static_cast<std::int64_t>(i));
    EXPECT_EQ(finished[i].update.constraints.size(), 4 - i);
    expect_true_constraints(finished[i]);
  }
  EXPECT_TRUE(finish_all(bare_window(0)).empty());
}

TEST_F(FinishedKeyframeTest, HasItsOwnCamera) {
  window_.camera << 301, 302, 160, 121;
  window_.keyframes[2]->leaving = true;
  const std::vector<FinishedKeyframe> leaving = finish_leaving(window_);
  ASSERT_EQ(leaving.size(), 1u);
  window_ = bare_window(0);
  EXPECT_EQ(leaving[0].update.camera.fx, 301);
  EXPECT_EQ(leaving[0].update.camera.fy, 302);
  EXPECT_EQ(leaving[0].update.camera.cx, 160);
  EXPECT_EQ(leaving[0].update.camera.cy, 121);
}

TEST(MapPointTest, ItsDeviationGrowsWithTheResiduals) {
  ActivePoint point;
  point.idepth_hessian = 400;
  EXPECT_FLOAT_EQ(make_map_point(point, 9).idepth_stddev, 3 / 20.0f);
  Window window = bare_window(2);
  window.rmse = 2;
  EXPECT_EQ(window.residual_variance(), kResidualCorrelation * 4);
  window.rmse = 0;  // Is not believed.
  EXPECT_GT(window.residual_variance(), 1);
}

TEST(MapPointTest, ItsDeviationIsFiniteWhateverItsHessian) {
  ActivePoint point;
  for (const float hessian : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    point.idepth_hessian = hessian;
    EXPECT_TRUE(std::isfinite(make_map_point(point, 1).idepth_stddev)) << hessian;
  }
}

TEST_F(FinishedKeyframeTest, KeepsImageCornersAndPoints) {
  window_.keyframes[2]->leaving = true;
  const std::vector<FinishedKeyframe> leaving = finish_leaving(window_);
  ASSERT_EQ(leaving.size(), 1u);
  EXPECT_EQ(leaving[0].frame, window_.keyframes[2]->frame);
  EXPECT_EQ(leaving[0].corners, window_.keyframes[2]->corners);
  // Its active points were marginalized before it leaves: those that still are active are none of the map.
  ASSERT_EQ(leaving[0].update.points.size(), 1u);
  EXPECT_EQ(leaving[0].update.points[0].idepth, 3);
  // At the end they come along, if enough residuals confirm them.
  const std::vector<FinishedKeyframe> all = finish_all(window_);
  ASSERT_EQ(all.size(), 5u);
  ASSERT_EQ(all[2].update.points.size(), 2u);
  const MapPoint& point = all[2].update.points[1];
  EXPECT_EQ(point.u, 33);
  EXPECT_EQ(point.idepth, 0.25f);
  // Residuals of 1 grey level, correlated.
  EXPECT_FLOAT_EQ(point.idepth_stddev, static_cast<float>(std::sqrt(kResidualCorrelation)) / 20.0f);
  EXPECT_TRUE(point.is_corner);
  EXPECT_EQ(all[4].corners, window_.keyframes[4]->corners);
}

}  // namespace
}  // namespace ldso
