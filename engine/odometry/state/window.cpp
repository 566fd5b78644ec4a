#include "odometry/state/window.h"

#include <utility>

namespace ldso {

Keyframe& Window::append(std::shared_ptr<const PreparedFrame> frame, const SE3d& T_c_w, const Brightness& brightness) {
  auto keyframe = std::make_unique<Keyframe>();
  keyframe->frame = std::move(frame);
  keyframe->state = {T_c_w, brightness, FrameVector::Zero()};
  for (auto& host : keyframes) {
    for (ActivePoint& point : host->points) {
      point.newest_states = {ResidualState::kInlier, point.newest_states[0]};
      PointResidual residual;
      residual.target = keyframe.get();
      point.residuals.push_back(residual);
    }
  }
  keyframes.push_back(std::move(keyframe));
  renumber();
  prior.append(kFrameDof);
  return *keyframes.back();
}

void Window::forget(const Keyframe& target) {
  for (auto& keyframe : keyframes) {
    for (ActivePoint& point : keyframe->points) {
      std::erase_if(point.residuals, [&](const PointResidual& r) { return r.target == &target; });
    }
  }
}

Window Window::clone() const {
  Window copy;
  static_cast<WindowVariables&>(copy) = *this;
  for (const auto& keyframe : keyframes) copy.keyframes.push_back(std::make_unique<Keyframe>(*keyframe));
  for (auto& host : copy.keyframes) {
    for (ActivePoint& point : host->points) {
      for (PointResidual& residual : point.residuals) residual.target = copy.keyframes[residual.target->index].get();
    }
  }
  return copy;
}

void Window::drop_newest() {
  forget(*keyframes.back());
  keyframes.pop_back();
  prior.drop_last(kFrameDof);
}

}  // namespace ldso
