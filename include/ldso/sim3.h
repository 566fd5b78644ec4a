#pragma once

// Similarities: rotation, translation and scale, with the exponential coordinates of their Lie group.
// The closed forms of this group have singularities at angle 0, at log scale 0 and at both; its two
// integrals are instead evaluated as one matrix function that has none.

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "ldso/error.h"
#include "ldso/se3.h"
#include "ldso/so3.h"

namespace ldso {

/// phi(A) = sum_n A^n / (n + 1)! = integral of exp(s A) for s from 0 to 1, for any square matrix: Taylor
/// series of A / 2^k, then k doublings phi(2 A) = (exp(A) + I) phi(A) / 2 with exp(A) = I + A phi(A).
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, N> matrix_phi(const Eigen::Matrix<Scalar, N, N>& A) {
  using Matrix = Eigen::Matrix<Scalar, N, N>;
  Scalar norm = A.cwiseAbs().colwise().sum().maxCoeff();
  Matrix B = A;
  int doublings = 0;
  for (; norm > Scalar(0.5) && doublings < 60; ++doublings) {
    norm *= Scalar(0.5);
    B *= Scalar(0.5);
  }
  Matrix phi = Matrix::Identity();
  for (int n = 13; n >= 2; --n) phi = Matrix::Identity() + B * phi / Scalar(n);  // 0.5^13 / 14! < 2e-15 of double
  for (; doublings > 0; --doublings) {
    phi = phi + Scalar(0.5) * B * phi * phi;
    B *= Scalar(2);
  }
  return phi;
}

/// A similarity `p -> s R p + t`, s > 0. Tangents are [rho; omega; sigma], sigma = log s.
/// The left Jacobian J of the exponential satisfies exp(x + dx) = exp(J(x) dx) * exp(x) to first order.
template <class Scalar>
class Sim3 {
 public:
  static constexpr int kDof = 7;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Matrix4 = Eigen::Matrix<Scalar, 4, 4>;
  using Tangent = Eigen::Matrix<Scalar, 7, 1>;   ///< [rho; omega; sigma], omega [rad].
  using Jacobian = Eigen::Matrix<Scalar, 7, 7>;  ///< Linear map of tangents.

  /// The identity.
  Sim3() : t_(Vector3::Zero()), scale_(1) {}

  /// `scale` must be positive.
  Sim3(const SO3<Scalar>& rotation, const Vector3& translation, const Scalar& scale)
      : R_(rotation), t_(translation), scale_(scale) {}

  /// The similarity p -> scale * R p + t of a rigid motion (R, t).
  explicit Sim3(const SE3<Scalar>& T, const Scalar& scale = Scalar(1)) : Sim3(T.rotation(), T.translation(), scale) {}

  /// From a homogeneous matrix; its rotation is made orthogonal, its last row is not read.
  /// Throws Error as SO3::from_matrix.
  static Sim3 from_matrix(const Matrix4& matrix) {
    using std::cbrt;
    const Matrix3 sR = matrix.template topLeftCorner<3, 3>();
    const SO3<Scalar> rotation = SO3<Scalar>::from_matrix(sR);
    return Sim3(rotation, matrix.template topRightCorner<3, 1>(), cbrt(sR.determinant()));
  }

  static Sim3 exp(const Tangent& x) {
    using std::exp;
    const Vector3 rho = x.template head<3>();
    const Scalar scale = exp(x[6]);
    return Sim3(SO3<Scalar>::exp(x.template segment<3>(3)), translation_map(x) * rho, scale);
  }

  /// Rotation vector of length at most pi.
  Tangent log() const {
    using std::log;
    Tangent x = Tangent::Zero();
    x.template segment<3>(3) = R_.log();
    x[6] = log(scale_);
    const Matrix3 W = translation_map(x);
    x.template head<3>() = W.inverse() * t_;
    return x;
  }

  Sim3 inverse() const {
    const SO3<Scalar> R_inverse = R_.inverse();
    const Scalar scale_inverse = Scalar(1) / scale_;
    return Sim3(R_inverse, -scale_inverse * (R_inverse * t_), scale_inverse);
  }

  const SO3<Scalar>& rotation() const { return R_; }
  SO3<Scalar>& rotation() { return R_; }
  const Vector3& translation() const { return t_; }
  Vector3& translation() { return t_; }
  const Scalar& scale() const { return scale_; }
  Scalar& scale() { return scale_; }
  Matrix3 rotation_matrix() const { return R_.matrix(); }

  Matrix4 matrix() const {
    Matrix4 m = Matrix4::Identity();
    m.template topLeftCorner<3, 3>() = scale_ * R_.matrix();
    m.template topRightCorner<3, 1>() = t_;
    return m;
  }

  /// exp(adjoint() * x) = S * exp(x) * S^-1.
  Jacobian adjoint() const {
    const Matrix3 R = R_.matrix();
    Jacobian result = Jacobian::Zero();
    result.template block<3, 3>(0, 0) = scale_ * R;
    result.template block<3, 3>(0, 3) = SO3<Scalar>::hat(t_) * R;
    result.template block<3, 1>(0, 6) = -t_;
    result.template block<3, 3>(3, 3) = R;
    result(6, 6) = Scalar(1);
    return result;
  }

  /// The Lie algebra's matrix of a tangent: exp(x) is its matrix exponential.
  static Matrix4 hat(const Tangent& x) {
    Matrix4 m = Matrix4::Zero();
    m.template topLeftCorner<3, 3>() = scaled_hat(x);
    m.template topRightCorner<3, 1>() = x.template head<3>();
    return m;
  }

  /// The adjoint of the Lie algebra, ad(x) y = [x, y].
  static Jacobian small_adjoint(const Tangent& x) {
    Jacobian result = Jacobian::Zero();
    result.template block<3, 3>(0, 0) = scaled_hat(x);
    result.template block<3, 3>(0, 3) = SO3<Scalar>::hat(x.template head<3>());
    result.template block<3, 1>(0, 6) = -x.template head<3>();
    result.template block<3, 3>(3, 3) = SO3<Scalar>::hat(x.template segment<3>(3));
    return result;
  }

  static Jacobian left_jacobian(const Tangent& x) { return matrix_phi<Scalar, 7>(small_adjoint(x)); }

  /// Exists for angles below 2 pi.
  static Jacobian left_jacobian_inverse(const Tangent& x) { return left_jacobian(x).inverse(); }

  template <class Other>
  Sim3<Other> cast() const {
    return Sim3<Other>(R_.template cast<Other>(), t_.template cast<Other>(), static_cast<Other>(scale_));
  }

  Sim3 operator*(const Sim3& other) const {
    return Sim3(R_ * other.R_, scale_ * (R_ * other.t_) + t_, scale_ * other.scale_);
  }
  Sim3& operator*=(const Sim3& other) { return *this = *this * other; }
  Vector3 operator*(const Vector3& p) const { return scale_ * (R_ * p) + t_; }

 private:
  /// hat(omega) + sigma I, the logarithm of s R.
  static Matrix3 scaled_hat(const Tangent& x) {
    Matrix3 m = SO3<Scalar>::hat(x.template segment<3>(3));
    m.diagonal().setConstant(x[6]);
    return m;
  }

  /// The matrix that maps rho to the translation of exp(x).
  static Matrix3 translation_map(const Tangent& x) { return matrix_phi<Scalar, 3>(scaled_hat(x)); }

  SO3<Scalar> R_;
  Vector3 t_;
  Scalar scale_;
};

using Sim3d = Sim3<double>;
using Sim3f = Sim3<float>;

}  // namespace ldso
