#include "odometry/window/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "odometry/test_rendered_path.h"

namespace ldso {
namespace {

bool take_all(const ActivePoint&) { return true; }

std::vector<ActivePoint*> points_of(const std::vector<PointChunk>& chunks) {
  std::vector<ActivePoint*> points;
  for (const PointChunk& chunk : chunks) points.insert(points.end(), chunk.points.begin(), chunk.points.end());
  return points;
}

/// The full system over the window's variables and all inverse depths, in double, without any structure.
struct DenseSystem {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;

  DenseSystem(const Window& window, const FramePairs& pairs, const std::vector<PointChunk>& chunks) {
    const int dim = window.dim();
    const auto count = static_cast<int>(points_of(chunks).size());
    H.setZero(dim + count, dim + count);
    b.setZero(dim + count);
    int index = dim;
    for (const PointChunk& chunk : chunks) {
      for (const ActivePoint* point : chunk.points) {
        for (const PointResidual& residual : point->residuals) add(window, pairs, chunk.host, *point, residual, index);
        H(index, index) += point->idepth_damping;
        ++index;
      }
    }
  }

  void add(const Window& window, const FramePairs& pairs, int host, const ActivePoint& point,
           const PointResidual& residual, int index) {
    if (residual.states[window.front] != ResidualState::kInlier) return;
    const FramePair& pair = pairs(host, residual.target->index);
    ProjectionJacobian J;
    ASSERT_TRUE(projection_jacobian(pair, point.u, point.v, point.idepth, J));
    // Rows: pixel x, pixel y, relative a, relative b. A residual is their combination with (gx, gy, d/da, d/db).
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(4, b.size());
    Eigen::Matrix<double, 4, kFrameDof> relative = Eigen::Matrix<double, 4, kFrameDof>::Zero();
    relative.topLeftCorner<2, 6>() = J.pose.cast<double>();
    relative(2, 6) = relative(3, 7) = 1;
    rows.block(0, 0, 2, kCameraDof) = J.camera.cast<double>();
    rows.block(0, Window::offset(residual.target->index), 4, kFrameDof) += relative;
    rows.block(0, Window::offset(host), 4, kFrameDof) += relative * pair.host_adjoint;
    rows.block(0, index, 2, 1) = J.idepth.cast<double>();
    const PatternSums& s = residual.sums[window.front];
    Eigen::Matrix4d M;
    M << s.gxx, s.gxy, s.gxa, s.gxb, s.gxy, s.gyy, s.gya, s.gyb, s.gxa, s.gya, s.aa, s.ab, s.gxb, s.gyb, s.ab, s.bb;
    H += rows.transpose() * M * rows;
    b += rows.transpose() * Eigen::Vector4d(s.rgx, s.rgy, s.ra, s.rb);
  }
};

class NormalEquationsTest : public test::RenderedPathTest<3> {
 protected:
  /// Three keyframes with points, a bit away from the truth: residuals below the Huber threshold.
  static Window make_window(int spacing) {
    Window window = test::true_window(*scene_, frames_, spacing);
    test::disturb(window, 0.003, 0.0012, 0.01, 0.7, 0.01, 5);
    return window;
  }

  ThreadPool pool_{1};
};

/// b = J^T W r is half the gradient of the energy, for each variable.
TEST_F(NormalEquationsTest, GradientMatchesDifferencesOfTheEnergy) {
  Window window = make_window(9);
  const auto chunks = chunk_points(window, take_all);
  const FramePairs pairs(window);
  const double energy = linearize(window, pairs, chunks, window.front, pool_);
  NormalEquationsBuilder builder(pool_);
  const NormalEquations equations = builder.build(window, pairs, chunks, 0);
  const auto energy_now = [&] { return linearize(window, FramePairs(window), chunks, 1 - window.front, pool_); };
  const auto check = [&](int variable, double step, const std::function<void(double)>& move) {
    move(step);
    const double above = energy_now();
    move(-2 * step);
    const double below = energy_now();
    move(step);
    const double half_gradient = (above - below) / (4 * step);
    // |J^T W r| is at most sqrt(H_ii E).
    const double bound = std::sqrt(equations.H(variable, variable) * energy);
    // Central differences are a few per cent below the slope of the interpolated intensities.
    EXPECT_NEAR(equations.b[variable], half_gradient, 0.035 * std::abs(half_gradient) + 0.002 * bound)
        << "variable " << variable << ", bound " << bound;
  };
  // Warps are in single precision: a twentieth of a pixel of the focal length would drown in their rounding.
  constexpr double kCameraStep = 0.3, kTranslationStep = 2e-4, kRotationStep = 1e-4, kAStep = 1e-3, kBStep = 0.1;
  for (int i = 0; i < kCameraDof; ++i) check(i, kCameraStep, [&](double step) { window.camera[i] += step; });
  for (int frame = 0; frame < window.size(); ++frame) {
    for (int i = 0; i < kFrameDof; ++i) {
      const double step = i < 3 ? kTranslationStep : i < 6 ? kRotationStep : i == 6 ? kAStep : kBStep;
      check(Window::offset(frame) + i, step, [&](double s) { window.keyframes[frame]->state.delta[i] += s; });
    }
  }
}

TEST_F(NormalEquationsTest, GradientOfInverseDepthsMatchesDifferencesOfTheEnergy) {
  Window window = make_window(20);
  const auto chunks = chunk_points(window, take_all);
  const FramePairs pairs(window);
  linearize(window, pairs, chunks, window.front, pool_);
  NormalEquationsBuilder builder(pool_);
  builder.build(window, pairs, chunks, 0);
  builder.back_substitute(chunks, Eigen::VectorXd::Zero(window.dim()));
  double error = 0, total = 0, product = 0;
  int count = 0;
  for (const PointChunk& chunk : chunks) {
    for (ActivePoint* point : chunk.points) {
      if (!(point->idepth_hessian > 1)) continue;
      // With all else fixed the step is -b / H.
      const double b = -static_cast<double>(point->idepth_step) * point->idepth_hessian;
      const PointChunk one{chunk.host, {point}};
      const float before = point->idepth;
      constexpr float kStep = 1e-3f;
      point->idepth = before + kStep;
      const double above = linearize(window, pairs, {one}, 1 - window.front, pool_);
      point->idepth = before - kStep;
      const double below = linearize(window, pairs, {one}, 1 - window.front, pool_);
      point->idepth = before;
      const double numeric = (above - below) / (4.0 * kStep);
      error += (numeric - b) * (numeric - b);
      total += numeric * numeric;
      product += numeric * b;
      ++count;
    }
  }
  EXPECT_GT(count, 200);
  // Gradients are interpolated central differences; the slope of interpolated intensities jumps at pixel borders.
  // For one pattern that makes a few percent, over all points it averages out.
  EXPECT_LT(std::sqrt(error / total), 0.07);
  EXPECT_NEAR(product / total, 1, 0.02);
}

TEST_F(NormalEquationsTest, AccumulationMatchesADenseSystem) {
  Window window = make_window(24);
  const auto chunks = chunk_points(window, take_all);
  for (ActivePoint* point : points_of(chunks)) point->idepth_damping = point->u < 100 ? 50.0f : 0.0f;
  const FramePairs pairs(window);
  linearize(window, pairs, chunks, window.front, pool_);
  NormalEquationsBuilder builder(pool_);
  const NormalEquations equations = builder.build(window, pairs, chunks, 0);
  const DenseSystem dense(window, pairs, chunks);
  const int dim = window.dim();
  const auto count = static_cast<int>(dense.b.size()) - dim;
  ASSERT_GT(count, 150);
  const Eigen::VectorXd scale = dense.H.diagonal().head(dim).cwiseSqrt().cwiseInverse();
  const auto scaled = [&](const Eigen::MatrixXd& H) {
    return Eigen::MatrixXd(scale.asDiagonal() * H * scale.asDiagonal());
  };
  EXPECT_LT(scaled(equations.H - dense.H.topLeftCorner(dim, dim)).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT(scale.cwiseProduct(equations.b - dense.b.head(dim)).norm(),
            1e-4 * scale.cwiseProduct(dense.b.head(dim)).norm());
  const Eigen::MatrixXd C = dense.H.topRightCorner(dim, count);
  const Eigen::VectorXd inverse = dense.H.diagonal().tail(count).cwiseInverse();
  const Eigen::MatrixXd H_sc = C * inverse.asDiagonal() * C.transpose();
  const Eigen::VectorXd b_sc = C * inverse.cwiseProduct(dense.b.tail(count));
  EXPECT_LT(scaled(equations.H_sc - H_sc).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT(scale.cwiseProduct(equations.b_sc - b_sc).norm(), 1e-4 * scale.cwiseProduct(b_sc).norm());
  int index = dim;
  for (const ActivePoint* point : points_of(chunks)) {
    EXPECT_NEAR(point->idepth_hessian, dense.H(index, index), 1e-4 * dense.H(index, index));
    ++index;
  }
}

/// Reduced system plus back-substitution give what the full system of all variables gives.
TEST_F(NormalEquationsTest, SchurComplementSolvesTheFullSystem) {
  for (const double damping : {0.0, 0.3}) {
    Window window = make_window(24);
    const auto chunks = chunk_points(window, take_all);
    const FramePairs pairs(window);
    linearize(window, pairs, chunks, window.front, pool_);
    NormalEquationsBuilder builder(pool_);
    const NormalEquations equations = builder.build(window, pairs, chunks, damping);
    const int dim = window.dim();
    // Priors fix the gauge, as the window's do.
    const Eigen::VectorXd prior = 0.01 * equations.H.diagonal();
    Eigen::MatrixXd H = equations.H - equations.H_sc;
    H.diagonal() += prior;
    const Eigen::VectorXd step = -H.ldlt().solve(equations.b - equations.b_sc);
    builder.back_substitute(chunks, step);
    DenseSystem dense(window, pairs, chunks);
    dense.H.diagonal().head(dim) += prior;
    dense.H.diagonal().tail(dense.b.size() - dim) *= 1 + damping;
    // Points that no other keyframe sees stay where they are.
    for (double& h : dense.H.diagonal()) h = h > 0 ? h : 1;
    const Eigen::VectorXd scale = dense.H.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * dense.H * scale.asDiagonal();
    const Eigen::VectorXd full = -scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(dense.b)));
    EXPECT_LT((step - full.head(dim)).cwiseQuotient(scale.head(dim)).norm(),
              1e-3 * full.head(dim).cwiseQuotient(scale.head(dim)).norm());
    double error = 0, total = 0;
    int index = dim;
    for (const ActivePoint* point : points_of(chunks)) {
      error += std::pow(point->idepth_step - full[index], 2);
      total += full[index] * full[index];
      ++index;
    }
    EXPECT_LT(std::sqrt(error / total), 1e-3);
  }
}

TEST_F(NormalEquationsTest, PointsWithoutParallaxTakeNoPart) {
  // Two views from almost one place: the inverse depths are not determined and must not be eliminated.
  Window window = test::empty_window(scene_->camera());
  const SE3d T(SO3d(), Eigen::Vector3d(1e-7, 0, 0));
  test::add_keyframe(window, frames_[0], SE3d());
  test::add_keyframe(window, frames_[0], T);
  test::add_points(window, *window.keyframes[0], *scene_, SE3d(), 20);
  const auto chunks = chunk_points(window, take_all);
  const FramePairs pairs(window);
  linearize(window, pairs, chunks, window.front, pool_);
  NormalEquationsBuilder builder(pool_);
  const NormalEquations equations = builder.build(window, pairs, chunks, 0);
  EXPECT_EQ(equations.H_sc.norm(), 0);
  EXPECT_EQ(equations.b_sc.norm(), 0);
  EXPECT_GT(equations.H.norm(), 0);
  builder.back_substitute(chunks, Eigen::VectorXd::Constant(window.dim(), 0.01));
  for (const ActivePoint* point : points_of(chunks)) EXPECT_EQ(point->idepth_step, 0);
}

TEST_F(NormalEquationsTest, OutliersAndPointsOutOfViewTakeNoPart) {
  Window window = make_window(24);
  const auto chunks = chunk_points(window, take_all);
  const FramePairs pairs(window);
  std::vector<ActivePoint*> points = points_of(chunks);
  // Outliers by their looks, and points that leave the view.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 10 == 0) {
      for (float& intensity : points[i]->patch.intensity) intensity += intensity < 128 ? 80.0f : -80.0f;
    }
    if (i % 10 == 5) points[i]->idepth = 30;
  }
  const double energy = linearize(window, pairs, chunks, window.front, pool_);
  double inliers = 0, outliers = 0;
  int out_of_view = 0;
  for (const PointChunk& chunk : chunks) {
    for (const ActivePoint* point : chunk.points) {
      for (const PointResidual& r : point->residuals) {
        const float threshold = std::max(window.keyframes[chunk.host]->outlier_energy, r.target->outlier_energy);
        const PatternSums& s = r.sums[window.front];
        const ResidualState expected = !s.in_view             ? ResidualState::kOutOfView
                                       : s.energy > threshold ? ResidualState::kOutlier
                                                              : ResidualState::kInlier;
        EXPECT_EQ(r.states[window.front], expected);
        if (expected == ResidualState::kInlier) inliers += s.energy;
        if (expected == ResidualState::kOutlier) outliers += threshold;
        out_of_view += expected == ResidualState::kOutOfView ? 1 : 0;
      }
    }
  }
  EXPECT_GT(outliers, 1e4);
  EXPECT_GT(out_of_view, 30);
  EXPECT_NEAR(energy, inliers + outliers, 1e-6 * energy);
  NormalEquationsBuilder builder(pool_);
  const NormalEquations equations = builder.build(window, pairs, chunks, 0);
  const DenseSystem dense(window, pairs, chunks);
  EXPECT_LT((equations.H - dense.H.topLeftCorner(window.dim(), window.dim())).norm(), 1e-5 * equations.H.norm());

  // A lower threshold makes outliers of inliers without a new linearization.
  for (auto& keyframe : window.keyframes) keyframe->outlier_energy = 0;
  EXPECT_EQ(reclassify(window, chunks, window.front), 0);
  EXPECT_EQ(builder.build(window, pairs, chunks, 0).H.norm(), 0);
}

TEST_F(NormalEquationsTest, ThreadsDoNotChangeABit) {
  Window window = make_window(9);
  const auto chunks = chunk_points(window, take_all);
  ASSERT_GT(chunks.size(), 6u);
  const FramePairs pairs(window);
  ThreadPool three(3);
  const double energy_1 = linearize(window, pairs, chunks, window.front, pool_);
  const double energy_3 = linearize(window, pairs, chunks, window.front, three);
  EXPECT_EQ(energy_1, energy_3);
  const NormalEquations one = NormalEquationsBuilder(pool_).build(window, pairs, chunks, 0.1);
  const NormalEquations other = NormalEquationsBuilder(three).build(window, pairs, chunks, 0.1);
  EXPECT_EQ(one.H, other.H);
  EXPECT_EQ(one.b, other.b);
  EXPECT_EQ(one.H_sc, other.H_sc);
  EXPECT_EQ(one.b_sc, other.b_sc);
}

}  // namespace
}  // namespace ldso
