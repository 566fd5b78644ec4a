#include "mapping/matching/p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ldso {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triple = std::array<Vector3d, 3>;

/// The problem in its distances: with lambda_i the distance of point i and pair k opposite of point k,
/// lambda_i^2 + lambda_j^2 - 2 cosine_k lambda_i lambda_j = side_squared_k.
struct Distances {
  Vector3d side_squared;  ///< Of pairs (1, 2), (0, 2), (0, 1); the longest is 1.
  Vector3d cosine;        ///< Between the bearings of those pairs.
  double unit = 1;        ///< Length of the longest side in the points' unit.
};

/// The points of each pair, which has the number of the third one.
constexpr int kPairs[3][2] = {{1, 2}, {0, 2}, {0, 1}};

/// False for a triangle or for bearings that determine no pose.
bool measure(const Triple& bearings, const Triple& points, Distances& d) {
  constexpr double kSmall = 1e-9;  // relative to the longest side, and of the angle between bearings [rad]
  for (int k = 0; k < 3; ++k) {
    const auto [i, j] = kPairs[k];
    d.side_squared[k] = (points[i] - points[j]).squaredNorm();
    d.cosine[k] = bearings[i].dot(bearings[j]);
    if (!(bearings[i].cross(bearings[j]).norm() > kSmall)) return false;  // also NaN
  }
  const double longest = d.side_squared.maxCoeff();
  const double twice_area = (points[1] - points[0]).cross(points[2] - points[0]).norm();
  if (!std::isfinite(longest) || !(twice_area > kSmall * longest)) return false;
  d.unit = std::sqrt(longest);
  d.side_squared /= longest;
  return true;
}

/// Left sides of the three equations as a quadratic form in lambda.
Matrix3d form_of_pair(const Distances& d, int k) {
  const auto [i, j] = kPairs[k];
  Matrix3d M = Matrix3d::Zero();
  M(i, i) = M(j, j) = 1;
  M(i, j) = M(j, i) = -d.cosine[k];
  return M;
}

/// Real roots of c3 x^3 + c2 x^2 + c1 x + c0 with |c3| the largest in size of c3 and c0, thus not zero unless both
/// are; Viete's and Cardano's formulas, then Newton's to get back the digits they lose.
int solve_cubic(double c3, double c2, double c1, double c0, std::array<double, 3>& roots) {
  const double a = c2 / c3, b = c1 / c3, c = c0 / c3;
  const double q = (a * a - 3 * b) / 9, r = (a * (2 * a * a - 9 * b) + 27 * c) / 54;
  int count = 1;
  if (r * r < q * q * q) {
    const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0)) / 3;
    for (int k = 0; k < 3; ++k) {
      roots[k] = -2 * std::sqrt(q) * std::cos(angle + (k - 1) * 2 * std::numbers::pi / 3) - a / 3;
    }
    count = 3;
  } else {
    const double A = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
    roots[0] = A + (A != 0 ? q / A : 0) - a / 3;
  }
  for (int k = 0; k < count; ++k) {
    for (int step = 0; step < 3; ++step) {
      const double x = roots[k];
      const double slope = (3 * x + 2 * a) * x + b;
      const double next = x - (((x + a) * x + b) * x + c) / slope;
      if (!std::isfinite(next)) break;
      roots[k] = next;
    }
  }
  return count;
}

/// The coefficient of x in det(A + x B).
double mixed_determinant(const Matrix3d& A, const Matrix3d& B) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    Matrix3d C = A;
    C.col(k) = B.col(k);
    sum += C.determinant();
  }
  return sum;
}

/// The two lines (planes through the origin in lambda) of a degenerate conic of the pencil.
struct LinePair {
  Vector3d first, second;  ///< Normals of unit length.
  double quality = 0;      ///< 0: none; larger: the better separated.
};

LinePair lines_of(const Matrix3d& D) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(D);
  const Vector3d& values = eigen.eigenvalues();  // ascending; the middle one is 0 but for rounding
  LinePair lines;
  if (!(values[0] < 0 && values[2] > 0)) return lines;
  const Vector3d p = std::sqrt(values[2]) * eigen.eigenvectors().col(2);
  const Vector3d m = std::sqrt(-values[0]) * eigen.eigenvectors().col(0);
  lines.first = (p - m).normalized();
  lines.second = (p + m).normalized();
  lines.quality = std::min(-values[0], values[2]) / std::max(-values[0], values[2]);
  return lines;
}

/// Two conics through the solutions: the equations' differences in which the sizes cancel. The longest side serves
/// as the reference, so that they stay independent of each other however short another side is.
std::array<Matrix3d, 2> conics(const Distances& d, const std::array<Matrix3d, 3>& forms) {
  int longest = 0;
  d.side_squared.maxCoeff(&longest);
  const int i = (longest + 1) % 3, j = (longest + 2) % 3;
  const Matrix3d A = forms[i] - d.side_squared[i] * forms[longest];
  const Matrix3d B = forms[j] - d.side_squared[j] * forms[longest];
  // Symmetric triangles seen symmetrically make A, B, A - B and the like degenerate themselves; a turned basis of the
  // pencil keeps the cubic's outer coefficients away from zero.
  const double c = std::cos(1.0), s = std::sin(1.0);
  return {c * A + s * B, c * B - s * A};
}

/// The degenerate conics of a pencil are those whose determinant is zero: a cubic. Any with real lines serves; the one
/// whose lines are best separated is the most accurate. `other` is the one of the two that is less like it.
LinePair degenerate_conic(const std::array<Matrix3d, 2>& pencil, Matrix3d& other) {
  const double det_0 = pencil[0].determinant(), det_1 = pencil[1].determinant();
  const bool exchange = std::abs(det_0) > std::abs(det_1);  // so that the leading coefficient is the larger one
  const Matrix3d& base = pencil[exchange ? 1 : 0];
  const Matrix3d& added = pencil[exchange ? 0 : 1];
  std::array<double, 3> roots{};
  const int count = solve_cubic(exchange ? det_0 : det_1, mixed_determinant(added, base),
                                mixed_determinant(base, added), exchange ? det_1 : det_0, roots);
  LinePair best;
  for (int k = 0; k < count; ++k) {
    if (!std::isfinite(roots[k])) continue;
    const LinePair lines = lines_of((base + roots[k] * added) / (1 + std::abs(roots[k])));
    if (lines.quality <= best.quality) continue;
    best = lines;
    other = std::abs(roots[k]) < 1 ? added : base;
  }
  return best;
}

/// Directions lambda on the plane with this normal that lie on the conic: at most two.
int intersect(const Vector3d& normal, const Matrix3d& conic, std::array<Vector3d, 2>& directions) {
  const Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
  // a x^2 + 2 b x y + c y^2 = 0
  const double a = u.dot(conic * u), b = u.dot(conic * w), c = w.dot(conic * w);
  double discriminant = b * b - a * c;
  if (discriminant < 0 && discriminant > -1e-10 * (b * b + std::abs(a * c))) discriminant = 0;  // touches it
  if (!(discriminant >= 0)) return 0;
  const double t = -(b + std::copysign(std::sqrt(discriminant), b));  // without cancellation
  if (t == 0 && a == 0 && c == 0) return 0;
  directions = {t * u + a * w, c * u + t * w};  // y / x = a / t and t / c
  return 2;
}

Vector3d equations(const Distances& d, const Vector3d& lambda, Matrix3d* J) {
  Vector3d value;
  if (J != nullptr) J->setZero();
  for (int k = 0; k < 3; ++k) {
    const auto [i, j] = kPairs[k];
    value[k] =
        lambda[i] * lambda[i] + lambda[j] * lambda[j] - 2 * d.cosine[k] * lambda[i] * lambda[j] - d.side_squared[k];
    if (J == nullptr) continue;
    (*J)(k, i) = 2 * (lambda[i] - d.cosine[k] * lambda[j]);
    (*J)(k, j) = 2 * (lambda[j] - d.cosine[k] * lambda[i]);
  }
  return value;
}

/// Newton steps as long as they help. False if the equations do not hold in the end.
bool refine(const Distances& d, Vector3d& lambda) {
  double error = equations(d, lambda, nullptr).norm();
  for (int i = 0; i < 8 && error > 0; ++i) {
    Matrix3d J;
    const Vector3d value = equations(d, lambda, &J);
    const Vector3d next = lambda - J.partialPivLu().solve(value);
    const double next_error = equations(d, next, nullptr).norm();
    if (!(next_error < error)) break;
    lambda = next;
    error = next_error;
  }
  return error < 1e-9 * (1 + lambda.squaredNorm()) && lambda.minCoeff() > 0;
}

/// Distances in the direction of lambda: positive, and of the length that fits the triangle's size.
bool scale_distances(const Distances& d, const Matrix3d& sum_of_forms, Vector3d& lambda) {
  if (lambda.sum() < 0) lambda = -lambda;
  const double size = lambda.dot(sum_of_forms * lambda);
  if (!(lambda.minCoeff() > 0) || !(size > 0)) return false;
  lambda *= std::sqrt(d.side_squared.sum() / size);
  return lambda.allFinite();
}

/// An orthonormal frame that hangs on a triangle.
Matrix3d triad(const Triple& p) {
  Matrix3d frame;
  frame.col(0) = (p[1] - p[0]).normalized();
  frame.col(2) = frame.col(0).cross(p[2] - p[0]).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// The motion that maps the points to the congruent triangle at these distances along the bearings.
SE3d pose_from_distances(const Triple& bearings, const Triple& points, const Vector3d& lambda) {
  Triple seen;
  for (int i = 0; i < 3; ++i) seen[i] = lambda[i] * bearings[i];
  const Matrix3d R = triad(seen) * triad(points).transpose();
  const SO3d rotation{Eigen::Quaterniond(R)};
  const Vector3d mean_seen = (seen[0] + seen[1] + seen[2]) / 3, mean = (points[0] + points[1] + points[2]) / 3;
  return {rotation, mean_seen - rotation * mean};
}

}  // namespace

P3pSolutions solve_p3p(const Triple& bearings, const Triple& points) {
  P3pSolutions solutions;
  const Triple directions{bearings[0].normalized(), bearings[1].normalized(), bearings[2].normalized()};
  Distances d;
  if (!measure(directions, points, d)) return solutions;
  const std::array<Matrix3d, 3> forms{form_of_pair(d, 0), form_of_pair(d, 1), form_of_pair(d, 2)};
  Matrix3d conic = Matrix3d::Zero();
  const LinePair lines = degenerate_conic(conics(d, forms), conic);
  if (lines.quality <= 0) return solutions;
  const Matrix3d sum_of_forms = forms[0] + forms[1] + forms[2];
  for (const Vector3d& normal : {lines.first, lines.second}) {
    std::array<Vector3d, 2> lambdas;
    const int count = intersect(normal, conic, lambdas);
    for (int k = 0; k < count; ++k) {
      if (!scale_distances(d, sum_of_forms, lambdas[k]) || !refine(d, lambdas[k])) continue;
      const SE3d pose = pose_from_distances(directions, points, d.unit * lambdas[k]);
      if (pose.matrix().allFinite()) solutions.poses[solutions.count++] = pose;
    }
  }
  return solutions;
}

}  // namespace ldso
