#pragma once

// Rigid motions: a rotation and a translation, with the exponential coordinates of their Lie group.

#include <Eigen/Core>

#include "ldso/so3.h"

namespace ldso {

/// A rigid motion `p -> R p + t`. Tangents are [rho; omega], translation part first.
/// The left Jacobian J of the exponential satisfies exp(x + dx) = exp(J(x) dx) * exp(x) to first order.
template <class Scalar>
class SE3 {
 public:
  static constexpr int kDof = 6;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Matrix4 = Eigen::Matrix<Scalar, 4, 4>;
  using Tangent = Eigen::Matrix<Scalar, 6, 1>;   ///< [rho; omega], omega [rad].
  using Jacobian = Eigen::Matrix<Scalar, 6, 6>;  ///< Linear map of tangents.

  /// The identity.
  SE3() : t_(Vector3::Zero()) {}
  SE3(const SO3<Scalar>& rotation, const Vector3& translation) : R_(rotation), t_(translation) {}

  /// From a homogeneous matrix; its rotation is made orthogonal, its last row is not read.
  /// Throws Error as SO3::from_matrix.
  static SE3 from_matrix(const Matrix4& matrix) {
    return SE3(SO3<Scalar>::from_matrix(matrix.template topLeftCorner<3, 3>()), matrix.template topRightCorner<3, 1>());
  }

  static SE3 exp(const Tangent& x) {
    const Vector3 omega = x.template tail<3>();
    const Vector3 rho = x.template head<3>();
    return SE3(SO3<Scalar>::exp(omega), SO3<Scalar>::left_jacobian(omega) * rho);
  }

  /// Rotation vector of length at most pi.
  Tangent log() const {
    const Vector3 omega = R_.log();
    Tangent x;
    x.template head<3>() = SO3<Scalar>::left_jacobian_inverse(omega) * t_;
    x.template tail<3>() = omega;
    return x;
  }

  SE3 inverse() const {
    const SO3<Scalar> R_inverse = R_.inverse();
    return SE3(R_inverse, -(R_inverse * t_));
  }

  const SO3<Scalar>& rotation() const { return R_; }
  SO3<Scalar>& rotation() { return R_; }
  const Vector3& translation() const { return t_; }
  Vector3& translation() { return t_; }
  Matrix3 rotation_matrix() const { return R_.matrix(); }

  Matrix4 matrix() const {
    Matrix4 m = Matrix4::Identity();
    m.template topLeftCorner<3, 3>() = R_.matrix();
    m.template topRightCorner<3, 1>() = t_;
    return m;
  }

  /// exp(adjoint() * x) = T * exp(x) * T^-1.
  Jacobian adjoint() const {
    const Matrix3 R = R_.matrix();
    Jacobian result = Jacobian::Zero();
    result.template topLeftCorner<3, 3>() = R;
    result.template topRightCorner<3, 3>() = SO3<Scalar>::hat(t_) * R;
    result.template bottomRightCorner<3, 3>() = R;
    return result;
  }

  /// The Lie algebra's matrix of a tangent: exp(x) is its matrix exponential.
  static Matrix4 hat(const Tangent& x) {
    Matrix4 m = Matrix4::Zero();
    m.template topLeftCorner<3, 3>() = SO3<Scalar>::hat(x.template tail<3>());
    m.template topRightCorner<3, 1>() = x.template head<3>();
    return m;
  }

  /// The adjoint of the Lie algebra, ad(x) y = [x, y].
  static Jacobian small_adjoint(const Tangent& x) {
    const Matrix3 omega_hat = SO3<Scalar>::hat(x.template tail<3>());
    Jacobian result = Jacobian::Zero();
    result.template topLeftCorner<3, 3>() = omega_hat;
    result.template topRightCorner<3, 3>() = SO3<Scalar>::hat(x.template head<3>());
    result.template bottomRightCorner<3, 3>() = omega_hat;
    return result;
  }

  static Jacobian left_jacobian(const Tangent& x) {
    const Matrix3 J = SO3<Scalar>::left_jacobian(x.template tail<3>());
    Jacobian result = Jacobian::Zero();
    result.template topLeftCorner<3, 3>() = J;
    result.template topRightCorner<3, 3>() = coupling(x);
    result.template bottomRightCorner<3, 3>() = J;
    return result;
  }

  /// Exists for angles below 2 pi.
  static Jacobian left_jacobian_inverse(const Tangent& x) {
    const Matrix3 J_inverse = SO3<Scalar>::left_jacobian_inverse(x.template tail<3>());
    Jacobian result = Jacobian::Zero();
    result.template topLeftCorner<3, 3>() = J_inverse;
    result.template topRightCorner<3, 3>() = -J_inverse * coupling(x) * J_inverse;
    result.template bottomRightCorner<3, 3>() = J_inverse;
    return result;
  }

  template <class Other>
  SE3<Other> cast() const {
    return SE3<Other>(R_.template cast<Other>(), t_.template cast<Other>());
  }

  SE3 operator*(const SE3& other) const { return SE3(R_ * other.R_, R_ * other.t_ + t_); }
  SE3& operator*=(const SE3& other) { return *this = *this * other; }
  Vector3 operator*(const Vector3& p) const { return R_ * p + t_; }

 private:
  /// Upper right block of the left Jacobian: Barfoot, State Estimation for Robotics, eq. 7.86.
  static Matrix3 coupling(const Tangent& x) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const Matrix3 P = SO3<Scalar>::hat(x.template head<3>());
    const Matrix3 W = SO3<Scalar>::hat(x.template tail<3>());
    const Scalar t2 = x.template tail<3>().squaredNorm();
    // Power series of the coefficients, alternating in t^2; below angle 1 they have neglected terms
    // under 1e-17, and above it the closed forms lose no more than two digits.
    Scalar a = series(t2, 6, 3);
    Scalar b = series(t2, 24, 4);
    Scalar c = weighted_series(t2);
    if (t2 > Scalar(1)) {
      const Scalar t = sqrt(t2);
      a = (t - sin(t)) / (t2 * t);
      b = (t2 + Scalar(2) * cos(t) - Scalar(2)) / (Scalar(2) * t2 * t2);
      c = (Scalar(2) * t - Scalar(3) * sin(t) + t * cos(t)) / (Scalar(2) * t2 * t2 * t);
    }
    const Matrix3 WP = W * P;
    const Matrix3 PW = P * W;
    const Matrix3 WPW = WP * W;
    return Scalar(0.5) * P + a * (WP + PW + WPW) + b * (W * WP + PW * W - Scalar(3) * WPW) + c * (WPW * W + W * WPW);
  }

  /// sum_k (-t2)^k / (2k + first)! with first! given.
  static Scalar series(const Scalar& t2, int first_factorial, int first) {
    Scalar term = Scalar(1) / Scalar(first_factorial);
    Scalar sum = term;
    for (int n = first; n < first + 16; n += 2) {
      term *= -t2 / Scalar((n + 1) * (n + 2));
      sum += term;
    }
    return sum;
  }

  /// (2 t - 3 sin t + t cos t) / (2 t^5) = sum_k (-t2)^k (k + 1) / (2k + 5)!.
  static Scalar weighted_series(const Scalar& t2) {
    Scalar term = Scalar(1) / Scalar(120);
    Scalar sum = term;
    for (int k = 1; k <= 8; ++k) {
      term *= -t2 / Scalar((2 * k + 4) * (2 * k + 5));
      sum += Scalar(k + 1) * term;
    }
    return sum;
  }

  SO3<Scalar> R_;
  Vector3 t_;
};

using SE3d = SE3<double>;
using SE3f = SE3<float>;

}  // namespace ldso
