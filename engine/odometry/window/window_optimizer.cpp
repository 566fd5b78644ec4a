#include "odometry/window/window_optimizer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "odometry/window/gauge.h"

namespace ldso {
namespace {

/// Damping multiplies the diagonal before depths are eliminated: much of what is left for weak directions (scale, focal
/// length, slow drift of depths). With 0.1 those hardly move within the iterations there are (the kitchen's ATE was
/// 0.04 to 0.24 m over seven first frames, now it is 0.05 to 0.06 m); with 1e-3 they follow noise where the camera
/// drives straight on (a street's ATE doubles).
/// After a step that is not accepted it rises by far: the next one has to succeed, iterations are few.
constexpr DampingRule kWindowDamping{.first = 1e-2, .least = 1e-5, .down = 0.25, .up = 100};
/// Root mean square over the keyframes below which the change of the brightness a is small. The step is if those of
/// rotation and translation are, too.
constexpr double kSmallBrightness = 6e-4;
/// The same of a small rotation [rad].
constexpr double kSmallRotation = 6e-5;
/// The same of a small translation, in proportion to the mean depth.
constexpr double kSmallTranslation = 6e-5;
/// Root of a pattern's energy beyond which a residual would be an outlier if all keyframes had the same threshold
/// [grey levels]. A keyframe's own lies halfway between this and what its residuals say.
constexpr float kFixedOutlierRoot = 26.0f;
/// What a keyframe's residuals say: the energy that this share of them stays below.
constexpr double kOutlierQuantile = 0.7;
/// The threshold exceeds the mean of both by this factor.
constexpr float kOutlierSlack = 1.5f;
/// From this iteration on the step may not change the scale (DSO section 2.3).
constexpr int kFirstFixedScaleIteration = 2;

void back_up(Window& window) {
  window.camera_backup = window.camera;
  for (auto& keyframe : window.keyframes) {
    keyframe->delta_backup = keyframe->state.delta;
    for (ActivePoint& point : keyframe->points) point.idepth_backup = point.idepth;
  }
}

void apply_step(Window& window, const Eigen::VectorXd& step) {
  window.camera = window.camera_backup + step.head<kCameraDof>();
  for (auto& keyframe : window.keyframes) {
    keyframe->state.delta = keyframe->delta_backup + step.segment<kFrameDof>(Window::offset(keyframe->index));
    for (ActivePoint& point : keyframe->points) {
      point.idepth = std::max(0.0f, point.idepth_backup + point.idepth_step);
    }
  }
}

void restore(Window& window) {
  window.camera = window.camera_backup;
  for (auto& keyframe : window.keyframes) {
    keyframe->state.delta = keyframe->delta_backup;
    for (ActivePoint& point : keyframe->points) point.idepth = point.idepth_backup;
  }
}

/// Root mean square steps below the precision of the images.
bool is_small(const Window& window, const Eigen::VectorXd& step) {
  double rotation = 0, translation = 0, brightness = 0, idepth_sum = 0;
  int points = 0;
  for (const auto& keyframe : window.keyframes) {
    const auto x = step.segment<kFrameDof>(Window::offset(keyframe->index));
    translation += x.head<3>().squaredNorm();
    rotation += x.segment<3>(3).squaredNorm();
    brightness += x[6] * x[6];
    for (const ActivePoint& point : keyframe->points) idepth_sum += std::abs(point.idepth_backup);
    points += static_cast<int>(keyframe->points.size());
  }
  const double frames = window.size();
  const double idepth = points > 0 ? idepth_sum / points : 1.0;
  return std::sqrt(brightness / frames) < kSmallBrightness && std::sqrt(rotation / frames) < kSmallRotation &&
         std::sqrt(translation / frames) * idepth < kSmallTranslation;
}

/// Energy beyond which a residual into the newest keyframe is an outlier, from the spread of all of them.
void update_outlier_energy(Window& window) {
  Keyframe& newest = *window.keyframes.back();
  std::vector<float> energies;
  for (const auto& keyframe : window.keyframes) {
    for (const ActivePoint& point : keyframe->points) {
      for (const PointResidual& residual : point.residuals) {
        if (residual.target != &newest || residual.states[window.front] == ResidualState::kOutOfView) continue;
        energies.push_back(residual.sums[window.front].energy);
      }
    }
  }
  if (energies.empty()) return;
  const auto middle =
      energies.begin() + static_cast<std::ptrdiff_t>(kOutlierQuantile * static_cast<double>(energies.size()));
  std::nth_element(energies.begin(), middle, energies.end());
  const float threshold = 0.5f * kFixedOutlierRoot + 0.5f * kOutlierSlack * std::sqrt(*middle);
  newest.outlier_energy = threshold * threshold;
}

}  // namespace

double prior_energy(const Window& window) {
  double energy = window.prior.energy(window.delta());
  energy += window.camera_prior.dot((window.camera - window.camera_lin).cwiseAbs2());
  for (const auto& keyframe : window.keyframes) {
    energy += keyframe->prior.dot((keyframe->state.delta - keyframe->prior_mean).cwiseAbs2());
  }
  return energy;
}

OptimizationReport WindowOptimizer::optimize(Window& window, int max_iterations) {
  OptimizationReport report;
  const auto chunks = chunk_points(window, [](const ActivePoint& p) { return !p.residuals.empty(); });
  damping_ = LevenbergDamping(kWindowDamping);
  energy_ = linearize(window, FramePairs(window), chunks, window.front, pool_);
  update_outlier_energy(window);
  energy_ = reclassify(window, chunks, window.front) + prior_energy(window);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    report.iterations = iteration + 1;
    report.finite = try_step(window, chunks, iteration);
    if (!report.finite || small_step_) break;
  }
  settle(window, chunks, report);
  return report;
}

bool WindowOptimizer::try_step(Window& window, const std::vector<PointChunk>& chunks, int iteration) {
  const NormalEquations equations = builder_.build(window, FramePairs(window), chunks, damping_.value());
  const Eigen::VectorXd step = solve(window, equations, iteration >= kFirstFixedScaleIteration);
  if (!step.allFinite()) return false;
  builder_.back_substitute(chunks, step);
  back_up(window);
  apply_step(window, step);
  small_step_ = is_small(window, step);
  const int tried = 1 - window.front;
  const double energy = linearize(window, FramePairs(window), chunks, tried, pool_) + prior_energy(window);
  if (energy < energy_) {
    window.front = tried;
    energy_ = energy;
    damping_.relax();
  } else {
    restore(window);
    damping_.stiffen();
  }
  return true;
}

Eigen::VectorXd WindowOptimizer::solve(Window& window, const NormalEquations& equations, bool fix_scale) const {
  const Eigen::VectorXd delta = window.delta();
  Eigen::MatrixXd H = equations.H + window.prior.H;
  Eigen::VectorXd b = equations.b + window.prior.gradient(delta);
  H.diagonal().head<kCameraDof>() += window.camera_prior;
  b.head<kCameraDof>() += window.camera_prior.cwiseProduct(delta.head<kCameraDof>());
  for (const auto& keyframe : window.keyframes) {
    const int offset = Window::offset(keyframe->index);
    H.diagonal().segment<kFrameDof>(offset) += keyframe->prior;
    b.segment<kFrameDof>(offset) += keyframe->prior.cwiseProduct(keyframe->state.delta - keyframe->prior_mean);
  }
  window.hessian = H - equations.H_sc;
  damping_.damp(H);
  H -= equations.H_sc;
  b -= equations.b_sc;
  const Eigen::VectorXd scale = (H.diagonal().array().abs() + 10).sqrt().inverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  Eigen::VectorXd step = -scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(b)));
  if (fix_scale) remove_scale(window, step);
  return step;
}

void WindowOptimizer::settle(Window& window, const std::vector<PointChunk>& chunks, OptimizationReport& report) {
  for (auto& keyframe : window.keyframes) {
    if (!keyframe->in_prior) keyframe->relinearize();
  }
  const double energy = linearize(window, FramePairs(window), chunks, window.front, pool_);
  update_outlier_energy(window);
  report.energy = energy;
  const Keyframe* newest = window.keyframes.back().get();
  double inlier_energy = 0;
  for (const PointChunk& chunk : chunks) {
    for (ActivePoint* point : chunk.points) {
      for (const PointResidual& residual : point->residuals) {
        const ResidualState state = residual.states[window.front];
        if (residual.target == newest) point->newest_states[0] = state;
        if (state != ResidualState::kInlier) continue;
        ++point->good_residuals;
        ++report.residuals;
        inlier_energy += residual.sums[window.front].energy;
      }
      std::erase_if(point->residuals,
                    [&](const PointResidual& r) { return r.states[window.front] != ResidualState::kInlier; });
    }
  }
  if (report.residuals > 0) report.rmse = std::sqrt(inlier_energy / (report.residuals * kPatternSize));
  window.rmse = report.rmse;
}

}  // namespace ldso
