#include "geometry/odd_polynomial.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace ldso {
namespace {

/// Smallest x > 0 with g'(x) = 0. With u = x^2, g' = 1 + 3 k1 u + 5 k2 u^2 + ...; in w = 1 / u it is monic,
/// so that the eigenvalues of its companion matrix are found without dividing by small coefficients.
double first_turning_point(const std::array<double, 4>& k) {
  int degree = 4;
  while (degree > 0 && k[degree - 1] == 0) --degree;
  if (degree == 0) return std::numeric_limits<double>::infinity();
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (int i = 0; i < degree; ++i) companion(0, i) = -(2 * i + 3) * k[i];
  for (int i = 1; i < degree; ++i) companion(i, i - 1) = 1;
  const Eigen::VectorXcd roots = companion.eigenvalues();
  double largest = 0;
  for (const std::complex<double>& w : roots) {
    if (std::abs(w.imag()) <= 1e-9 * std::abs(w)) largest = std::max(largest, w.real());
  }
  return largest > 0 ? 1 / std::sqrt(largest) : std::numeric_limits<double>::infinity();
}

}  // namespace

OddPolynomial::OddPolynomial(const std::array<double, 4>& k, double largest_argument)
    : k_(k), end_(std::min(first_turning_point(k), largest_argument)) {}

double OddPolynomial::value(double x) const {
  const double u = x * x;
  return x * (1 + u * (k_[0] + u * (k_[1] + u * (k_[2] + u * k_[3]))));
}

double OddPolynomial::derivative(double x) const {
  const double u = x * x;
  return 1 + u * (3 * k_[0] + u * (5 * k_[1] + u * (7 * k_[2] + u * 9 * k_[3])));
}

// Not more than twice the solution if that is above 1, so that Newton's steps start near it.
double OddPolynomial::upper_bound(double y) const {
  if (std::isfinite(end_)) return end_;
  double x = 1;
  while (value(x) < y) x *= 2;
  return x;
}

std::optional<double> OddPolynomial::inverse(double y) const {
  if (!(y >= 0) || !std::isfinite(y)) return std::nullopt;
  double low = 0;
  double high = upper_bound(y);
  if (!(y < value(high)) && std::isfinite(end_)) return std::nullopt;
  // Newton's steps where they stay in the bracket, bisection elsewhere.
  double x = std::min(y, 0.5 * high);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double error = value(x) - y;
    if (error == 0) break;
    (error > 0 ? high : low) = x;
    double next = x - error / derivative(x);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - x);
    x = next;
    if (step <= 1e-16 * x) break;
  }
  return x;
}

}  // namespace ldso
