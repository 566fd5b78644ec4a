#include "scaling/tag_views.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "geometry/camera_model.h"
#include "io/images/april_tag.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Images that are looked at: a tag takes some milliseconds each.
constexpr std::size_t kMostImages = 600;

/// Of the detected corners [px].
constexpr double kCornerStddev = 0.2;

/// Smaller tags have corners that cannot be told from their bits [px].
constexpr double kLeastSide = 16;

/// Grey levels in proportion to the light, if the response is known.
void undo_response(const PhotometricCalibration& photometric, Image<float>& grey) {
  if (!photometric.inverse_response) return;
  const auto& table = *photometric.inverse_response;
  std::transform(grey.data(), grey.data() + grey.size(), grey.data(), [&](float value) {
    return table[static_cast<std::size_t>(std::clamp(std::lround(value), 0L, 255L))];
  });
}

/// The tag, if it is in the image once and large enough.
std::optional<SeenTag> detect(const AprilTag& tag, const Image<float>& grey) {
  std::vector<SeenTag> seen = find_april_tags(grey.view(), tag.family);
  std::erase_if(seen, [&](const SeenTag& other) { return other.id != tag.id; });
  if (seen.size() != 1) return std::nullopt;
  const auto& corners = seen.front().corners;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((corners[i] - corners[(i + 1) % 4]).norm() < kLeastSide) return std::nullopt;
  }
  return seen.front();
}

std::optional<TagView> view_of(const SeenTag& tag, const SE3d& pose, const CameraModel& model) {
  TagView view;
  view.T_world_camera = pose;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto ray = model.unproject(tag.corners[i]);
    if (!ray) return std::nullopt;
    view.rays[i] = ray->normalized();
  }
  view.ray_stddev = kCornerStddev / model.calibration().fx;
  return view;
}

}  // namespace

std::vector<TagView> find_tag(const AprilTag& tag, const SlamResult& result, const Calibration& calibration,
                              const Dataset& dataset) {
  const std::unique_ptr<CameraModel> model = make_camera_model(calibration.camera);
  const std::vector<TimedPose> poses = result.trajectory();
  const std::size_t step = std::max<std::size_t>(1, (poses.size() + kMostImages - 1) / kMostImages);
  std::vector<TagView> views;
  for (std::size_t i = 0; i < poses.size(); i += step) {
    try {
      RawFrame frame = dataset.read(static_cast<int>(poses[i].frame_id));
      undo_response(calibration.photometric, frame.grey);
      const std::optional<SeenTag> seen = detect(tag, frame.grey);
      if (!seen) continue;
      if (const auto view = view_of(*seen, poses[i].T_world_camera, *model)) views.push_back(*view);
    } catch (const Error&) {
      continue;
    }
  }
  return views;
}

}  // namespace ldso
