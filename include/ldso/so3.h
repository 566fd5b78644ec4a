#pragma once

// Rotations in three dimensions as unit quaternions, with the exponential coordinates of their Lie
// group. Formulas are arranged so that nothing is lost near angle 0 and near angle pi.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "ldso/error.h"

namespace ldso {

/// A rotation `p -> R p`. `Scalar` is float or double.
/// The left Jacobian J of the exponential satisfies exp(x + dx) = exp(J(x) dx) * exp(x) to first order.
template <class Scalar>
class SO3 {
 public:
  static constexpr int kDof = 3;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Quaternion = Eigen::Quaternion<Scalar>;
  using Tangent = Vector3;   ///< Rotation vector: axis times angle [rad].
  using Jacobian = Matrix3;  ///< Linear map of tangents.

  /// The identity.
  SO3() : q_(Quaternion::Identity()) {}

  /// Any quaternion but zero; it is normalized.
  explicit SO3(const Quaternion& q) : q_(q.normalized()) {}

  /// The rotation nearest to `matrix` in the Frobenius norm. Throws Error if there is none worth the
  /// name: not finite, or the determinant is not positive.
  static SO3 from_matrix(const Matrix3& matrix) {
    if (!matrix.allFinite() || !(matrix.determinant() > Scalar(0))) {
      throw Error("rotation matrix", "it is not finite or its determinant is not positive",
                  "pass a right-handed rotation matrix");
    }
    const Eigen::JacobiSVD<Matrix3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3 nearest = svd.matrixU() * svd.matrixV().transpose();
    return SO3(Quaternion(nearest));
  }

  static SO3 exp(const Tangent& omega) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const Scalar theta_squared = omega.squaredNorm();
    Scalar real = Scalar(1) - theta_squared / Scalar(8);
    Scalar imaginary = Scalar(0.5) - theta_squared / Scalar(48);  // sin(theta / 2) / theta
    if (theta_squared > Eigen::NumTraits<Scalar>::epsilon()) {
      const Scalar theta = sqrt(theta_squared);
      real = cos(theta / Scalar(2));
      imaginary = sin(theta / Scalar(2)) / theta;
    }
    const Vector3 vector = imaginary * omega;
    return SO3(Quaternion(real, vector.x(), vector.y(), vector.z()));
  }

  /// Rotation vector of length at most pi.
  Tangent log() const {
    using std::atan2;
    using std::sqrt;
    // q and -q are the same rotation; the one with w >= 0 has the smaller angle. The arc tangent of
    // both parts is exact where acos(w) (near 0) and asin(|v|) (near pi) are not.
    const Scalar sign = q_.w() < Scalar(0) ? Scalar(-1) : Scalar(1);
    const Scalar w = sign * q_.w();
    const Scalar n_squared = q_.vec().squaredNorm();
    Scalar factor = Scalar(2) / w - Scalar(2) * n_squared / (Scalar(3) * w * w * w);
    if (n_squared > Eigen::NumTraits<Scalar>::epsilon()) {
      const Scalar n = sqrt(n_squared);
      factor = Scalar(2) * atan2(n, w) / n;
    }
    return (sign * factor) * q_.vec();
  }

  SO3 inverse() const {
    SO3 result;
    result.q_ = q_.conjugate();
    return result;
  }

  Matrix3 matrix() const { return q_.toRotationMatrix(); }
  const Quaternion& quaternion() const { return q_; }

  /// exp(adjoint() * x) = R * exp(x) * R^-1.
  Jacobian adjoint() const { return matrix(); }

  /// The cross-product matrix: hat(a) * b = a x b.
  static Matrix3 hat(const Tangent& a) {
    Matrix3 m;
    m << Scalar(0), -a.z(), a.y(), a.z(), Scalar(0), -a.x(), -a.y(), a.x(), Scalar(0);
    return m;
  }

  /// The adjoint of the Lie algebra, ad(x) y = [x, y].
  static Jacobian small_adjoint(const Tangent& x) { return hat(x); }

  static Jacobian left_jacobian(const Tangent& omega) {
    using std::sin;
    using std::sqrt;
    const Scalar t2 = omega.squaredNorm();
    Scalar a = Scalar(0.5) - t2 / Scalar(24);             // (1 - cos t) / t^2
    Scalar b = Scalar(1) / Scalar(6) - t2 / Scalar(120);  // (t - sin t) / t^3
    // Below this the second neglected term is under the rounding error; above it the cancellation in
    // t - sin t is harmless, as b is multiplied with t^2.
    if (t2 * t2 > Eigen::NumTraits<Scalar>::epsilon()) {
      const Scalar t = sqrt(t2);
      const Scalar s = sin(t / Scalar(2));
      a = Scalar(2) * s * s / t2;
      b = (t - sin(t)) / (t2 * t);
    }
    const Matrix3 h = hat(omega);
    return Matrix3::Identity() + a * h + b * (h * h);
  }

  /// Exists for angles below 2 pi.
  static Jacobian left_jacobian_inverse(const Tangent& omega) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const Scalar t2 = omega.squaredNorm();
    Scalar c = Scalar(1) / Scalar(12) + t2 / Scalar(720);  // (1 - (t / 2) cot(t / 2)) / t^2
    if (t2 * t2 > Eigen::NumTraits<Scalar>::epsilon()) {
      const Scalar half = sqrt(t2) / Scalar(2);
      c = (Scalar(1) - half * cos(half) / sin(half)) / t2;
    }
    const Matrix3 h = hat(omega);
    return Matrix3::Identity() - Scalar(0.5) * h + c * (h * h);
  }

  template <class Other>
  SO3<Other> cast() const {
    return SO3<Other>(q_.template cast<Other>());
  }

  /// Normalized, so that long products stay rotations.
  SO3 operator*(const SO3& other) const { return SO3(q_ * other.q_); }
  SO3& operator*=(const SO3& other) { return *this = *this * other; }
  Vector3 operator*(const Vector3& p) const { return q_ * p; }

 private:
  Quaternion q_;
};

using SO3d = SO3<double>;
using SO3f = SO3<float>;

}  // namespace ldso
