#include "odometry/window/lens_equations.h"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "geometry/rolling_shutter.h"
#include "odometry/window/normal_equations.h"

namespace ldso {
namespace {

/// A point whose inverse depth is determined more weakly is taken as known.
constexpr double kLeastIdepthHessian = 1;

constexpr int kPairDof = kLensGlobalDof + kFrameDof;  ///< Global, relative pose and brightness.
constexpr int kPixelDof = kPairDof - 2;               ///< What moves the pixel: not the brightness.

using LensShift = Eigen::Matrix<double, 2, kLensDof>;
using PixelJacobian = Eigen::Matrix<double, 2, kPixelDof>;
using PairMatrix = Eigen::Matrix<double, kPairDof, kPairDof>;
using PairVector = Eigen::Matrix<double, kPairDof, 1>;

int offset(int keyframe) { return kLensGlobalDof + kFrameDof * keyframe; }

/// Jacobians of one residual's pixel.
struct ResidualJacobian {
  PixelJacobian pixel;
  Eigen::Vector2d idepth;
};

bool make_jacobian(const CameraModel& lens, const Window& window, int host, int target, const FramePair& pair,
                   const ActivePoint& point, const LensShift& host_shift, ResidualJacobian& J) {
  ProjectionJacobian base;
  if (!projection_jacobian(pair, point.u, point.v, point.idepth, base)) return false;
  const Eigen::Vector4d camera = pair.camera_lin.cast<double>();
  const Eigen::Matrix3d R = pair.R_lin.cast<double>();
  const Eigen::Vector3d ray((point.u - camera[2]) / camera[0], (point.v - camera[3]) / camera[1], 1.0);
  const Eigen::Vector3d p = R * ray + pair.t_lin.cast<double>() * point.idepth;
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << 1, 0, -p.x() / p.z(), 0, 1, -p.y() / p.z();
  // The host's pixel is given: if its lens shows rays further out, its true ray is further in.
  Eigen::Matrix<double, 2, kLensShutterDof> shift;
  shift.leftCols<kLensDof>() = lens_shift(lens, p.hnormalized()) - by_point / p.z() * R.leftCols<2>() * host_shift;
  const double target_row = row_time(camera[1] * p.y() / p.z() + camera[3], window.height);
  shift.col(kLensDof) =
      by_point / p.z() *
      (target_row * ray_velocity(window.keyframes[target]->velocity, p, point.idepth) -
       row_time(point.v, window.height) * R * ray_velocity(window.keyframes[host]->velocity, ray, point.idepth));
  J.pixel << base.camera.cast<double>(), camera.head<2>().asDiagonal() * shift, base.pose.cast<double>();
  J.idepth = base.idepth.cast<double>();
  return true;
}

/// Sums over the pattern of one residual: H and b over the pair's variables, and their coupling with the inverse depth.
struct PairEquations {
  PairMatrix H;
  PairVector b, coupling;
};

PairEquations pair_equations(const PatternSums& s, const ResidualJacobian& J) {
  const Eigen::Matrix2d gg = (Eigen::Matrix2d() << s.gxx, s.gxy, s.gxy, s.gyy).finished();
  /// Gradient times derivative by a and b, one column each.
  const Eigen::Matrix2d gc = (Eigen::Matrix2d() << s.gxa, s.gxb, s.gya, s.gyb).finished();
  PairEquations e;
  e.H.topLeftCorner<kPixelDof, kPixelDof>() = J.pixel.transpose() * gg * J.pixel;
  e.H.topRightCorner<kPixelDof, 2>() = J.pixel.transpose() * gc;
  e.H.bottomLeftCorner<2, kPixelDof>() = e.H.topRightCorner<kPixelDof, 2>().transpose();
  e.H.bottomRightCorner<2, 2>() << s.aa, s.ab, s.ab, s.bb;
  e.b << J.pixel.transpose() * Eigen::Vector2d(s.rgx, s.rgy), s.ra, s.rb;
  e.coupling << J.pixel.transpose() * (gg * J.idepth), gc.transpose() * J.idepth;
  return e;
}

/// Adds a vector over the variables of a pair to one over all: the host's tangent through the adjoint, the target's as
/// it is.
void add_vector(const PairVector& from, const FramePair& pair, int host, int target, Eigen::VectorXd& sum) {
  const FrameVector relative = from.tail<kFrameDof>();
  sum.head<kLensGlobalDof>() += from.head<kLensGlobalDof>();
  sum.segment<kFrameDof>(offset(target)) += relative;
  sum.segment<kFrameDof>(offset(host)) += pair.host_adjoint.transpose() * relative;
}

/// The same for a matrix.
void add_matrix(const PairMatrix& from, const FramePair& pair, int host, int target, Eigen::MatrixXd& sum) {
  using FrameMatrix = Eigen::Matrix<double, kFrameDof, kFrameDof>;
  using Mixed = Eigen::Matrix<double, kLensGlobalDof, kFrameDof>;
  const FrameMatrix relative = from.bottomRightCorner<kFrameDof, kFrameDof>(), A = pair.host_adjoint;
  const Mixed mixed = from.topRightCorner<kLensGlobalDof, kFrameDof>();
  const FrameMatrix target_host = relative * A;
  const Mixed mixed_host = mixed * A;
  const int t = offset(target), h = offset(host);
  sum.topLeftCorner<kLensGlobalDof, kLensGlobalDof>() += from.topLeftCorner<kLensGlobalDof, kLensGlobalDof>();
  sum.block<kLensGlobalDof, kFrameDof>(0, t) += mixed;
  sum.block<kFrameDof, kLensGlobalDof>(t, 0) += mixed.transpose();
  sum.block<kLensGlobalDof, kFrameDof>(0, h) += mixed_host;
  sum.block<kFrameDof, kLensGlobalDof>(h, 0) += mixed_host.transpose();
  sum.block<kFrameDof, kFrameDof>(t, t) += relative;
  sum.block<kFrameDof, kFrameDof>(t, h) += target_host;
  sum.block<kFrameDof, kFrameDof>(h, t) += target_host.transpose();
  sum.block<kFrameDof, kFrameDof>(h, h) += A.transpose() * target_host;
}

/// Sums over the residuals of one host, one entry a target.
class HostEquations {
 public:
  explicit HostEquations(int keyframes) : H_(keyframes, PairMatrix::Zero()), b_(keyframes, PairVector::Zero()) {}

  void add(int target, const PairEquations& e) {
    H_[target] += e.H;
    b_[target] += e.b;
  }

  void add_to(const FramePairs& pairs, int host, LensEquations& equations) const {
    for (int target = 0; target < static_cast<int>(H_.size()); ++target) {
      if (target == host) continue;
      add_matrix(H_[target], pairs(host, target), host, target, equations.H);
      add_vector(b_[target], pairs(host, target), host, target, equations.b);
    }
  }

 private:
  std::vector<PairMatrix> H_;
  std::vector<PairVector> b_;
};

void add_point(const Window& window, const CameraModel& lens, const FramePairs& pairs, int host,
               const ActivePoint& point, HostEquations& sums, LensEquations& equations) {
  const PinholeIntrinsics camera = window.intrinsics();
  const LensShift host_shift = lens_shift(lens, {(point.u - camera.cx) / camera.fx, (point.v - camera.cy) / camera.fy});
  Eigen::VectorXd coupling = Eigen::VectorXd::Zero(equations.b.size());
  double hessian = point.idepth_damping, gradient = 0;
  for (const PointResidual& residual : point.residuals) {
    if (residual.states[window.front] != ResidualState::kInlier) continue;
    const int target = residual.target->index;
    const FramePair& pair = pairs(host, target);
    const PatternSums& s = residual.sums[window.front];
    ResidualJacobian J;
    if (!make_jacobian(lens, window, host, target, pair, point, host_shift, J)) continue;
    const PairEquations e = pair_equations(s, J);
    sums.add(target, e);
    add_vector(e.coupling, pair, host, target, coupling);
    hessian += s.gxx * J.idepth.x() * J.idepth.x() + 2 * s.gxy * J.idepth.x() * J.idepth.y() +
               s.gyy * J.idepth.y() * J.idepth.y();
    gradient += s.rgx * J.idepth.x() + s.rgy * J.idepth.y();
  }
  if (hessian < kLeastIdepthHessian) return;
  equations.H.noalias() -= coupling / hessian * coupling.transpose();
  equations.b -= coupling * (gradient / hessian);
}

}  // namespace

Eigen::Matrix<double, 2, kLensDof> lens_shift(const CameraModel& lens, const Eigen::Vector2d& ray) {
  CameraModel::Matrix23 J_point;
  Eigen::Matrix2Xd J_parameters;
  lens.project(ray.homogeneous(), &J_point, &J_parameters);
  LensShift raw;
  const Eigen::Index known = std::min<Eigen::Index>(kLensDof, J_parameters.cols());
  raw.setZero();
  raw.leftCols(known) = J_parameters.leftCols(known);
  // The raw pixel moves so; which ray of the rectified image shows it is a matter of the lens as it was given.
  const Eigen::Matrix2d raw_by_ray = J_point.leftCols<2>();
  const LensShift shift = raw_by_ray.inverse() * raw;
  return shift.allFinite() ? shift : LensShift(LensShift::Zero());
}

LensEquations make_lens_equations(const Window& window, const CameraModel& lens) {
  LensEquations equations(offset(window.size()));
  const FramePairs pairs(window);
  for (const auto& keyframe : window.keyframes) {
    const int at = offset(keyframe->index);
    equations.H.diagonal().segment<kFrameDof>(at) += keyframe->prior;
    equations.b.segment<kFrameDof>(at) += keyframe->prior.cwiseProduct(keyframe->state.delta - keyframe->prior_mean);
    HostEquations sums(window.size());
    for (const ActivePoint& point : keyframe->points) {
      add_point(window, lens, pairs, keyframe->index, point, sums, equations);
    }
    sums.add_to(pairs, keyframe->index, equations);
  }
  return equations;
}

}  // namespace ldso
