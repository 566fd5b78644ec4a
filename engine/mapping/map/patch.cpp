#include "mapping/map/patch.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "image/interpolation.h"

namespace ldso {
namespace {

/// Of shift x, shift y, gain, offset.
constexpr int kUnknowns = 4;
constexpr double kSmallStep = 0.003;  // [px]

using Samples = std::array<Texel, Patch::kPixels>;

/// False if one of them cannot be used.
bool sample(const Image<Texel>& image, const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, Samples& samples) {
  const ImageView<const Texel> view = image.view();
  int i = 0;
  for (int y = -Patch::kRadius; y <= Patch::kRadius; ++y) {
    for (int x = -Patch::kRadius; x <= Patch::kRadius; ++x, ++i) {
      const Eigen::Vector2f p = (centre + warp * Eigen::Vector2d(x, y)).cast<float>();
      if (!is_interpolable(view, p.x(), p.y())) return false;
      samples[i] = quadratic(view, p.x(), p.y());
      if (samples[i].valid < 1) return false;
    }
  }
  return true;
}

struct Equations {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
};

/// Of image - (gain * patch + offset), which is linear in gain and offset: these are solved for anew in each step.
Equations linearize(const Patch& patch, const Samples& samples) {
  Equations e;
  for (int i = 0; i < Patch::kPixels; ++i) {
    const Eigen::Vector4d J(samples[i].dx, samples[i].dy, -static_cast<double>(patch.grey[i]), -1);
    e.H.noalias() += J * J.transpose();
    e.b.noalias() -= J * static_cast<double>(samples[i].intensity);
  }
  return e;
}

double sum_of_squares(const Patch& patch, const Samples& samples, double gain, double offset) {
  double sum = 0;
  for (int i = 0; i < Patch::kPixels; ++i) {
    sum += std::pow(samples[i].intensity - gain * patch.grey[i] - offset, 2);
  }
  return sum;
}

double correlation(const Patch& patch, const Samples& samples) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int i = 0; i < Patch::kPixels; ++i) {
    const double p = patch.grey[i], q = samples[i].intensity;
    a += p;
    b += q;
    aa += p * p;
    bb += q * q;
    ab += p * q;
  }
  constexpr double n = Patch::kPixels;
  return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
}

}  // namespace

Patch cut_patch(const Image<Texel>& image, float u, float v) {
  Patch patch;
  if (!std::isfinite(u) || !std::isfinite(v)) return patch;
  const auto left = static_cast<int>(std::lround(u)) - Patch::kRadius;
  const auto top = static_cast<int>(std::lround(v)) - Patch::kRadius;
  if (left < 0 || top < 0 || left + Patch::kSide > image.width() || top + Patch::kSide > image.height()) return patch;
  Patch cut;
  for (int i = 0; i < Patch::kPixels; ++i) {
    const Texel& texel = image(left + i % Patch::kSide, top + i / Patch::kSide);
    if (texel.valid < 1) return patch;
    cut.grey[i] = static_cast<std::uint8_t>(std::clamp(std::lround(texel.intensity), 0L, 255L));
  }
  return cut;
}

std::optional<PatchPosition> align_patch(const Patch& patch, const Image<Texel>& image, const Eigen::Vector2d& start,
                                         const Eigen::Matrix2d& warp, const PatchAlignmentSettings& settings) {
  PatchPosition found;
  found.pixel = start;
  if (!start.allFinite() || !warp.allFinite()) return std::nullopt;
  Samples samples;
  for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
    if (!sample(image, found.pixel, warp, samples)) return std::nullopt;
    const Equations e = linearize(patch, samples);
    const Eigen::LDLT<Eigen::Matrix4d> solver(e.H);
    const Eigen::Vector4d x = solver.solve(e.b);
    const double gain = x[2];
    if (!x.allFinite() || !(gain > 1 / settings.max_gain) || gain > settings.max_gain) return std::nullopt;
    if (x.head<2>().norm() < kSmallStep) {
      if (!(correlation(patch, samples) >= settings.min_correlation)) return std::nullopt;
      const double misfit = sum_of_squares(patch, samples, gain, x[3]) / (Patch::kPixels - kUnknowns);
      const double variance = std::max(misfit, settings.least_noise * settings.least_noise);
      found.covariance = variance * solver.solve(Eigen::Matrix4d::Identity()).topLeftCorner<2, 2>();
      if (!found.covariance.allFinite() || !(found.covariance.determinant() > 0)) return std::nullopt;
      return found;
    }
    found.pixel += x.head<2>();
    if (!((found.pixel - start).norm() <= settings.max_shift)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace ldso
