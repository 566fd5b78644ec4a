#include "odometry/window/marginalizer.h"

#include <algorithm>
#include <cmath>

#include "odometry/window/gauge.h"

namespace ldso {
namespace {

/// Residuals a point must have now to be worth keeping.
constexpr std::size_t kLeastResiduals = 3;
/// A point with that many good residuals may go when few keyframes that stay see it.
constexpr int kManyGoodResiduals = kLeastGoodResiduals + 10;

}  // namespace

bool Marginalizer::is_reliable(const ActivePoint& point) const {
  return point.residuals.size() >= kLeastResiduals && point.good_residuals >= kLeastGoodResiduals &&
         point.idepth_hessian > settings_.least_idepth_hessian && point.idepth > 0;
}

bool Marginalizer::leaves_view(const ActivePoint& point) const {
  const auto leaving = static_cast<std::size_t>(std::count_if(
      point.residuals.begin(), point.residuals.end(), [](const PointResidual& r) { return r.target->leaving; }));
  if (point.residuals.size() >= kLeastResiduals && point.good_residuals > kManyGoodResiduals &&
      point.residuals.size() - leaving < kLeastResiduals) {
    return true;
  }
  if (point.newest_states[0] == ResidualState::kOutOfView) return true;
  if (point.residuals.size() < 2) return false;
  return point.newest_states[0] == ResidualState::kOutlier && point.newest_states[1] == ResidualState::kOutlier;
}

void Marginalizer::remove_points(Window& window) {
  marginalize_points(window);
  for (auto& keyframe : window.keyframes) {
    std::erase_if(keyframe->points, [&](const ActivePoint& point) {
      const bool useless = point.residuals.empty() || !(point.idepth > 0);
      if (!point.flagged && !useless && !leaves_view(point) && !keyframe->leaving) return false;
      if (!point.flagged) ++keyframe->dropped;
      return true;
    });
  }
}

void Marginalizer::marginalize_points(Window& window) {
  for (auto& keyframe : window.keyframes) {
    for (ActivePoint& point : keyframe->points) {
      point.flagged = (keyframe->leaving || leaves_view(point)) && is_reliable(point);
      if (!point.flagged) continue;
      keyframe->finished.push_back(make_map_point(point, window.residual_variance()));
      keyframe->in_prior = true;
      for (PointResidual& residual : point.residuals) residual.target->in_prior = true;
    }
  }
  const auto chunks = chunk_points(window, [](const ActivePoint& point) { return point.flagged; });
  if (chunks.empty()) return;
  const NormalEquations equations = builder_.build(window, FramePairs(window), chunks, 0.0);
  Eigen::MatrixXd H = settings_.marginalization_weight * (equations.H - equations.H_sc);
  Eigen::VectorXd b = settings_.marginalization_weight * (equations.b - equations.b_sc);
  remove_gauge(window, H, b);
  window.prior.add(H, b, window.delta());
}

std::vector<FinishedKeyframe> Marginalizer::remove_keyframes(Window& window) {
  std::vector<FinishedKeyframe> finished = finish_leaving(window);
  WindowPrior known{window.hessian, Eigen::VectorXd::Zero(window.hessian.rows())};
  for (int i = 0; i < window.size();) {
    Keyframe* leaving = window.keyframes[i].get();
    if (!leaving->leaving) {
      ++i;
      continue;
    }
    window.forget(*leaving);
    window.prior.marginalize(Window::offset(i), kFrameDof, leaving->prior,
                             -leaving->prior.cwiseProduct(leaving->prior_mean));
    if (known.H.rows() == window.dim()) {
      known.marginalize(Window::offset(i), kFrameDof, FrameVector::Zero(), FrameVector::Zero());
    }
    window.keyframes.erase(window.keyframes.begin() + i);
    window.renumber();
  }
  window.hessian = known.H;
  return finished;
}

}  // namespace ldso
