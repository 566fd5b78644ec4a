#include "odometry/tracking/keyframe_policy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ldso {
namespace {

/// Share of a keyframe's points that are still in use.
double visible_share(const Keyframe& keyframe) {
  const auto in_use = static_cast<double>(keyframe.points.size() + keyframe.immature.size());
  const auto gone = static_cast<double>(keyframe.finished.size()) + keyframe.dropped;
  return in_use / std::max(1.0, in_use + gone);
}

double log_brightness(const Keyframe& from, const Keyframe& to) {
  return std::log(brightness_transfer(from.frame->exposure_ms, from.state.brightness(), to.frame->exposure_ms,
                                      to.state.brightness())
                      .factor);
}

/// Small distances to the others and a large one to the newest make a keyframe dispensable (DSO eq. 20).
int most_dispensable(const Window& window) {
  const auto center = [](const Keyframe& k) { return k.state.T_c_w().inverse().translation(); };
  const Eigen::Vector3d newest = center(*window.keyframes.back());
  int worst = -1;
  double worst_score = -std::numeric_limits<double>::infinity();
  for (int i = 0; i + 2 < window.size(); ++i) {
    if (window.keyframes[i]->leaving) continue;
    const Eigen::Vector3d here = center(*window.keyframes[i]);
    double crowding = 0;
    for (int j = 0; j + 1 < window.size(); ++j) {
      if (j != i && !window.keyframes[j]->leaving)
        crowding += 1.0 / (1e-5 + (here - center(*window.keyframes[j])).norm());
    }
    const double score = std::sqrt((here - newest).norm()) * crowding;
    if (score > worst_score) {
      worst_score = score;
      worst = i;
    }
  }
  return worst;
}

}  // namespace

bool needs_keyframe(const KeyframeSettings& settings, const FrameMotion& motion, int width, int height) {
  // Weights hold for pixels of a 640x480 image.
  const double size = static_cast<double>(width + height) / (640 + 480);
  const double change = settings.density * (settings.translation_weight * motion.flow_translation / size +
                                            settings.rotation_weight * motion.flow_full / size +
                                            settings.brightness_weight * std::abs(motion.log_brightness));
  return change > 1 || motion.rmse > 2 * motion.first_rmse;
}

void flag_leaving(const KeyframeSettings& settings, Window& window) {
  int staying = window.size();
  const Keyframe& newest = *window.keyframes.back();
  for (int i = 0; i + 2 < window.size(); ++i) {
    Keyframe& keyframe = *window.keyframes[i];
    const bool unseen = visible_share(keyframe) < settings.least_visible;
    const bool too_different = std::abs(log_brightness(keyframe, newest)) > settings.brightness_limit;
    if ((unseen || too_different) && staying > settings.window_min) {
      keyframe.leaving = true;
      --staying;
    }
  }
  while (staying > settings.window_max) {
    const int index = most_dispensable(window);
    if (index < 0) return;
    window.keyframes[index]->leaving = true;
    --staying;
  }
}

}  // namespace ldso
