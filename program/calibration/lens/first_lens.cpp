#include "calibration/lens/first_lens.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Fields of view along the longer side that are tried [degrees].
constexpr std::array kFieldsOfView{25.0, 40.0, 55.0, 70.0, 85.0, 105.0, 130.0, 155.0};
constexpr double kFirstOmega = 0.8;
constexpr std::size_t kTrialViews = 10;

/// To mean 0 and mean distance sqrt(2), by which homographies are estimated well.
Eigen::Matrix3d normalization(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  double spread = 0;
  for (const auto& p : points) spread += (p - mean).norm() / static_cast<double>(points.size());
  const double scale = std::numbers::sqrt2 / std::max(spread, 1e-12);
  Eigen::Matrix3d N;
  N << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return N;
}

/// Of the plane to the rays; at least four points.
Eigen::Matrix3d homography(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to) {
  const Eigen::Matrix3d N_from = normalization(from), N_to = normalization(to);
  Eigen::Matrix<double, 9, 9> M = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::RowVector3d p = (N_from * from[i].homogeneous()).transpose();
    const Eigen::Vector2d q = (N_to * to[i].homogeneous()).head<2>();
    Eigen::Matrix<double, 2, 9> A;
    A << p, Eigen::RowVector3d::Zero(), -q.x() * p, Eigen::RowVector3d::Zero(), p, -q.y() * p;
    M += A.transpose() * A;
  }
  const Eigen::Matrix<double, 9, 1> h =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>(M).eigenvectors().col(0);
  return N_to.inverse() * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data()) * N_from;
}

/// A lens of its kind with hardly any distortion that sees so far to the sides.
LensAndPoses lens_with_view(LensKind kind, int width, int height, double degrees) {
  LensAndPoses estimate;
  estimate.kind = kind;
  estimate.width = width;
  estimate.height = height;
  estimate.parameters.setZero(static_cast<Eigen::Index>(lens_parameter_names(kind).size()));
  estimate.parameters.head<4>() << 1, 1, 0.5 * (width - 1), 0.5 * (height - 1);
  if (kind == LensKind::kFov) estimate.parameters[4] = kFirstOmega;
  const double half = 0.5 * degrees * std::numbers::pi / 180;
  const Eigen::Vector3d side(std::tan(half), 0, 1);
  const double radius = estimate.lens().project(side, nullptr, nullptr).x() - estimate.parameters[2];
  estimate.parameters.head<2>().setConstant(0.5 * std::max(width, height) / radius);
  return estimate;
}

bool set_poses(const std::vector<ObservedView>& views, LensAndPoses& estimate) {
  estimate.poses.clear();
  const Lens lens = estimate.lens();
  for (const ObservedView& view : views) {
    const auto pose = board_pose(view, lens.model());
    if (!pose) return false;
    estimate.poses.push_back(*pose);
  }
  return true;
}

std::vector<ObservedView> some_of(const std::vector<ObservedView>& views) {
  if (views.size() <= kTrialViews) return views;
  std::vector<ObservedView> some;
  for (std::size_t i = 0; i < kTrialViews; ++i) some.push_back(views[i * views.size() / kTrialViews]);
  return some;
}

/// Poses from homographies hold where the lens is about right; they are refined together with it.
double improve(const std::vector<ObservedView>& views, LensAndPoses& estimate) {
  if (!set_poses(views, estimate)) return std::numeric_limits<double>::infinity();
  adjust_lens(views, {.all_parameters = false, .most_iterations = 15}, estimate);
  return adjust_lens(views, {.all_parameters = true, .most_iterations = 15}, estimate);
}

}  // namespace

std::optional<SE3d> board_pose(const ObservedView& view, const CameraModel& camera) {
  std::vector<Eigen::Vector2d> board, rays;
  for (std::size_t i = 0; i < view.board.size(); ++i) {
    const auto ray = camera.unproject(view.pixels[i]);
    if (!ray) continue;
    board.push_back(view.board[i].head<2>());
    rays.push_back(ray->head<2>());
  }
  if (board.size() < 4) return std::nullopt;
  Eigen::Matrix3d H = homography(board, rays);
  const double scale = 0.5 * (H.col(0).norm() + H.col(1).norm());
  if (!(scale > 0) || !H.allFinite()) return std::nullopt;
  H /= H(2, 2) < 0 ? -scale : scale;  // The board is before the camera.
  Eigen::Matrix3d R;
  R << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[2] < 1e-3) return std::nullopt;
  R = svd.matrixU() * svd.matrixV().transpose();
  if (R.determinant() < 0) return std::nullopt;
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = R;
  T.topRightCorner<3, 1>() = H.col(2);
  return SE3d::from_matrix(T);
}

std::optional<LensAndPoses> first_lens(const std::vector<ObservedView>& views, LensKind kind, int width, int height) {
  const std::vector<ObservedView> trial = some_of(views);
  std::optional<LensAndPoses> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double degrees : kFieldsOfView) {
    LensAndPoses estimate = lens_with_view(kind, width, height, degrees);
    const double cost = improve(trial, estimate);
    if (cost < least) best = estimate;
    least = std::min(least, cost);
  }
  if (best) best->poses.clear();
  return best;
}

}  // namespace ldso
