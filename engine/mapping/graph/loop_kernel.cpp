#include "mapping/graph/loop_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ldso {
namespace {

double largest(const std::vector<double>& chi2) {
  return chi2.empty() ? 0 : *std::max_element(chi2.begin(), chi2.end());
}

}  // namespace

double geman_mcclure_cost(double chi2, double kernel_squared) { return chi2 / (1 + chi2 / kernel_squared) / 2; }

double geman_mcclure_weight(double chi2, double kernel_squared) {
  const double ratio = 1 / (1 + chi2 / kernel_squared);
  return ratio * ratio;
}

double loop_variance_factor(std::vector<double> chi2) {
  if (chi2.empty()) return 1;
  const auto median = chi2.begin() + static_cast<std::ptrdiff_t>((chi2.size() - 1) / 2);
  std::nth_element(chi2.begin(), median, chi2.end());
  return std::max(*median / kMedianChi2OfSeven, 1.0);
}

LoopKernel::LoopKernel(const PoseGraphSettings& settings, const std::vector<double>& chi2, bool graduated)
    : settings_(settings), variance_factor_(loop_variance_factor(chi2)), is_final_(!graduated) {
  squared_ = graduated ? std::max(final_squared(), settings_.margin * largest(chi2)) : final_squared();
}

void LoopKernel::narrow(const std::vector<double>& chi2) {
  if (is_final_) return;
  // Never much wider than the largest residual: as soon as no loop is left that does not fit, this is the final one.
  const double next = std::min(squared_ / settings_.narrowing, settings_.margin * largest(chi2));
  variance_factor_ = loop_variance_factor(chi2);
  is_final_ = next <= final_squared();
  squared_ = std::max(final_squared(), next);
}

}  // namespace ldso
