#include "odometry/init/patch_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ldso {
namespace {

/// Steps on each level.
constexpr int kMaxIterations = 10;
/// Candidate starts are compared there: blurred enough, distinct enough.
constexpr int kStartLevel = 2;
/// A step that moves no pixel [px of the level].
constexpr float kConverged = 0.02f;
/// On one level; what moves farther jumps to something else [px of the level].
constexpr float kMaxMove = 5.0f;
/// Below it the patch shows something else.
constexpr double kMinCorrelation = 0.7;
/// Of an image, as the damping takes it [grey levels].
constexpr float kNoise = 5.0f;
/// Standard deviation of a level's start [px].
constexpr float kMoveStddev = 3.0f;
/// Holds a patch where its level starts: keeps edges from sliding along themselves.
constexpr float kDamping = kNoise * kNoise / (kMoveStddev * kMoveStddev);

bool inside(const Image<Texel>& image, float x, float y) {
  return x >= 0 && y >= 0 && x < static_cast<float>(image.width() - 1) && y < static_cast<float>(image.height() - 1);
}

bool corners_inside(const Image<Texel>& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp,
                    float radius) {
  for (const Eigen::Vector2f& corner : {Eigen::Vector2f(radius, radius), Eigen::Vector2f(radius, -radius)}) {
    const Eigen::Vector2f d = warp * corner;
    if (!inside(image, centre.x() + d.x(), centre.y() + d.y())) return false;
    if (!inside(image, centre.x() - d.x(), centre.y() - d.y())) return false;
  }
  return true;
}

float interpolate(const Image<Texel>& image, float x, float y) {
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const float fx = x - static_cast<float>(ix);
  const float fy = y - static_cast<float>(iy);
  const Texel* a = image.row(iy) + ix;
  const Texel* b = a + image.width();
  const float top = a[0].intensity + fx * (a[1].intensity - a[0].intensity);
  const float bottom = b[0].intensity + fx * (b[1].intensity - b[0].intensity);
  return top + fy * (bottom - top);
}

}  // namespace

PatchTracker::PatchTracker(const PreparedFrame& reference, const std::vector<Eigen::Vector2d>& pixels, ThreadPool& pool)
    : levels_(static_cast<int>(reference.pyramid.levels.size())), templates_(pixels.size() * levels_) {
  pool.for_chunks(static_cast<int>(pixels.size()), 64, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      for (int level = 0; level < levels_; ++level) {
        templates_[static_cast<std::size_t>(i) * levels_ + level] =
            make_template(reference.pyramid.levels[level], to_level(pixels[i], level));
      }
    }
  });
}

PatchTracker::Template PatchTracker::make_template(const Image<Texel>& image, const Eigen::Vector2d& centre) const {
  Template patch;
  const Eigen::Vector2f c = centre.cast<float>();
  const Eigen::Matrix2f identity = Eigen::Matrix2f::Identity();
  // One pixel more than the patch: its gradients are differences of samples, as the iterations see them.
  if (!corners_inside(image, c, identity, kRadius + 1) || !all_valid(image, c, identity)) return patch;
  for (int y = -kRadius, k = 0; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x, ++k) {
      const float px = c.x() + static_cast<float>(x);
      const float py = c.y() + static_cast<float>(y);
      patch.intensity[k] = interpolate(image, px, py);
      patch.gx[k] = 0.5f * (interpolate(image, px + 1, py) - interpolate(image, px - 1, py));
      patch.gy[k] = 0.5f * (interpolate(image, px, py + 1) - interpolate(image, px, py - 1));
    }
  }
  for (int k = 0; k < kPixels; ++k) {
    patch.hxx += patch.gx[k] * patch.gx[k];
    patch.hxy += patch.gx[k] * patch.gy[k];
    patch.hyy += patch.gy[k] * patch.gy[k];
    patch.sum_gx += patch.gx[k];
    patch.sum_gy += patch.gy[k];
    patch.mean += patch.intensity[k] / kPixels;
  }
  patch.hxx -= patch.sum_gx * patch.sum_gx * kOffsetShare;
  patch.hxy -= patch.sum_gx * patch.sum_gy * kOffsetShare;
  patch.hyy -= patch.sum_gy * patch.sum_gy * kOffsetShare;
  for (int k = 0; k < kPixels; ++k) {
    const float centred = patch.intensity[k] - patch.mean;
    patch.energy += centred * centred;
  }
  patch.usable = patch.energy > 1;
  return patch;
}

bool PatchTracker::sample(const Image<Texel>& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp,
                          float* values) {
  if (!corners_inside(image, centre, warp, kRadius)) return false;
  for (int y = -kRadius, k = 0; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x, ++k) {
      const float fx = static_cast<float>(x);
      const float fy = static_cast<float>(y);
      values[k] = interpolate(image, centre.x() + warp(0, 0) * fx + warp(0, 1) * fy,
                              centre.y() + warp(1, 0) * fx + warp(1, 1) * fy);
    }
  }
  return true;
}

bool PatchTracker::all_valid(const Image<Texel>& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp) {
  for (int y = -kRadius; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x) {
      const Eigen::Vector2f p = centre + warp * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      // Not lround, a slow call: a patch inside the image has no negative coordinates.
      // NOLINTNEXTLINE(bugprone-incorrect-roundings)
      if (image(static_cast<int>(p.x() + 0.5f), static_cast<int>(p.y() + 0.5f)).valid == 0) return false;
    }
  }
  return true;
}

PatchTracker::Misfit PatchTracker::misfit(const float* values, const Template& patch,
                                          const BrightnessTransfer& brightness) const {
  double sum = 0;
  double squared = 0;
  double mean = 0;
  for (int k = 0; k < kPixels; ++k) {
    const double e = values[k] - brightness.factor * patch.intensity[k] - brightness.offset;
    sum += e;
    squared += e * e;
    mean += values[k] / static_cast<double>(kPixels);
  }
  double product = 0;
  double energy = 0;
  for (int k = 0; k < kPixels; ++k) {
    const double centred = values[k] - mean;
    product += centred * (patch.intensity[k] - patch.mean);
    energy += centred * centred;
  }
  Misfit result;
  result.squared = squared - sum * sum * kOffsetShare;
  result.gain = product / patch.energy;
  result.mean = mean;
  result.correlation = product / std::sqrt(std::max(1e-12, energy * patch.energy));
  return result;
}

/// Gauss-Newton with the reference's gradients: with g the gain and A the warp, the gradient in the current
/// frame is g A^-T grad and the step -1/g A H^-1 sum(grad e). The patch's own offset is eliminated.
bool PatchTracker::align(const Image<Texel>& image, const Template& patch, const Eigen::Matrix2f& warp,
                         const BrightnessTransfer& brightness, Eigen::Vector2f& centre) const {
  const Eigen::Vector2f start = centre;
  const auto gain = static_cast<float>(brightness.factor);
  const auto offset = static_cast<float>(brightness.offset);
  Eigen::Matrix2f H;
  H << patch.hxx + kDamping, patch.hxy, patch.hxy, patch.hyy + kDamping;
  const Eigen::Matrix2f to_step = warp * H.inverse() / gain;
  float values[kPixels];
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!sample(image, centre, warp, values)) return false;
    float bx = 0;
    float by = 0;
    float sum = 0;
    for (int k = 0; k < kPixels; ++k) {
      const float e = values[k] - gain * patch.intensity[k] - offset;
      bx += patch.gx[k] * e;
      by += patch.gy[k] * e;
      sum += e;
    }
    bx -= patch.sum_gx * sum * kOffsetShare;
    by -= patch.sum_gy * sum * kOffsetShare;
    const Eigen::Vector2f step = -(to_step * Eigen::Vector2f(bx, by));
    centre += step;
    if (!((centre - start).squaredNorm() < kMaxMove * kMaxMove)) return false;
    if (step.squaredNorm() < kConverged * kConverged) return true;
  }
  return true;
}

Eigen::Vector2d PatchTracker::best_start(const PreparedFrame& current, std::size_t index,
                                         const PatchPrediction& prediction,
                                         const BrightnessTransfer& brightness) const {
  const int level = std::min(kStartLevel, levels_ - 1);
  const Template& patch = templates_[index * levels_ + level];
  Eigen::Vector2d best = prediction.starts.front();
  double best_squared = std::numeric_limits<double>::infinity();
  float values[kPixels];
  for (const Eigen::Vector2d& start : prediction.starts) {
    const Eigen::Vector2f centre = to_level(start, level).cast<float>();
    if (!patch.usable || !sample(current.pyramid.levels[level], centre, prediction.warp.cast<float>(), values)) {
      continue;
    }
    const double squared = misfit(values, patch, brightness).squared;
    if (squared < best_squared) {
      best_squared = squared;
      best = start;
    }
  }
  return best;
}

PatchMatch PatchTracker::track_patch(const PreparedFrame& current, std::size_t index, const PatchPrediction& prediction,
                                     const BrightnessTransfer& brightness) const {
  PatchMatch match;
  if (prediction.starts.empty() || !templates_[index * levels_].usable) return match;
  const Eigen::Matrix2f warp = prediction.warp.cast<float>();
  match.position = best_start(current, index, prediction, brightness);
  for (int level = std::min(prediction.coarsest, levels_ - 1); level >= 0; --level) {
    const Template& patch = templates_[index * levels_ + level];
    if (!patch.usable) continue;
    Eigen::Vector2f centre = to_level(match.position, level).cast<float>();
    const bool ok = align(current.pyramid.levels[level], patch, warp, brightness, centre);
    if (ok) match.position = from_level(centre.cast<double>(), level);
    if (!ok && level == 0) return match;
  }
  const Template& patch = templates_[index * levels_];
  const Image<Texel>& image = current.pyramid.levels[0];
  const Eigen::Vector2f centre = match.position.cast<float>();
  float values[kPixels];
  if (!sample(image, centre, warp, values) || !all_valid(image, centre, warp)) return match;
  const Misfit fit = misfit(values, patch, brightness);
  match.gain = fit.gain;
  match.mean = fit.mean;
  match.reference_mean = patch.mean;
  match.correlation = fit.correlation;
  match.found = fit.correlation > kMinCorrelation;
  // The misfit stands for noise and for all that the model leaves out; never below a grey level.
  const double variance = std::max(1.0, fit.squared / (kPixels - 3));
  Eigen::Matrix2d H;
  H << patch.hxx, patch.hxy, patch.hxy, patch.hyy;
  H += Eigen::Matrix2d::Identity() * kDamping;
  match.covariance =
      variance / (brightness.factor * brightness.factor) * prediction.warp * H.inverse() * prediction.warp.transpose();
  return match;
}

std::vector<PatchMatch> PatchTracker::track(const PreparedFrame& current,
                                            const std::vector<PatchPrediction>& predictions,
                                            const BrightnessTransfer& brightness, ThreadPool& pool) const {
  std::vector<PatchMatch> matches(predictions.size());
  pool.for_chunks(static_cast<int>(predictions.size()), 32, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) matches[i] = track_patch(current, i, predictions[i], brightness);
  });
  return matches;
}

}  // namespace ldso
