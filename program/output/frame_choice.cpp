#include "output/frame_choice.h"

#include <algorithm>

namespace ldso {
namespace {

/// Change of view from the first pose to each.
std::vector<double> changes(const std::vector<FramePose>& frames, double depth) {
  std::vector<double> sums(frames.size(), 0.0);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const SE3d T = frames[i - 1].T_world_camera.inverse() * frames[i].T_world_camera;
    sums[i] = sums[i - 1] + T.translation().norm() / depth + T.rotation().log().norm();
  }
  return sums;
}

/// The stretch of each frame. A camera that stands still is spread over its frames instead.
std::vector<std::size_t> stretches(const std::vector<FramePose>& frames, double depth, std::size_t count) {
  const std::vector<double> way = changes(frames, depth);
  std::vector<std::size_t> stretch_of;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double standing = static_cast<double>(i) / static_cast<double>(frames.size());
    const double share = way.back() > 0 ? way[i] / way.back() : standing;
    stretch_of.push_back(std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count))));
  }
  return stretch_of;
}

}  // namespace

std::vector<std::size_t> choose_frames(const std::vector<FramePose>& frames, double depth, std::size_t count,
                                       const std::function<double(std::size_t)>& sharpness) {
  std::vector<std::size_t> chosen;
  if (frames.size() <= count) {
    for (std::size_t i = 0; i < frames.size(); ++i) chosen.push_back(i);
    return chosen;
  }
  const std::vector<std::size_t> stretch_of = stretches(frames, depth, count);
  double best = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double sharp = sharpness(i);
    if (i == 0 || stretch_of[i] != stretch_of[i - 1]) {
      chosen.push_back(i);
      best = sharp;
    } else if (sharp > best) {
      chosen.back() = i;
      best = sharp;
    }
  }
  return chosen;
}

double sharpness(ImageView<const float> image) {
  double sum = 0;
  for (int y = 0; y + 1 < image.height; ++y) {
    const float *row = image.row(y), *below = image.row(y + 1);
    for (int x = 0; x + 1 < image.width; ++x) {
      const double dx = row[x + 1] - row[x], dy = below[x] - row[x];
      sum += dx * dx + dy * dy;
    }
  }
  const double pixels = static_cast<double>(image.width) * image.height;
  return pixels > 0 ? sum / pixels : 0;
}

}  // namespace ldso
