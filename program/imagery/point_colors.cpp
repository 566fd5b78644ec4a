#include "imagery/point_colors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/pinhole_projection.h"
#include "geometry/rolling_shutter.h"
#include "ldso/error.h"

namespace ldso {
namespace {

using Colors = std::map<std::int64_t, std::vector<Rgb>>;  ///< By keyframe.

/// Where the image of a keyframe, its rolling shutter not undone, shows its points.
std::vector<Eigen::Vector2d> pixels_of(const protocol::Keyframe& keyframe, const PinholeIntrinsics& camera,
                                       const ReadoutMotion& motion) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3f& point : keyframe.points) {
    const Eigen::Vector3d p = point.cast<double>();
    pixels.push_back(with_readout(camera, motion, project(camera, p), 1 / p.z()));
  }
  return pixels;
}

bool any_has_color(const Dataset& sequence, const std::vector<protocol::Keyframe>& keyframes) {
  if (keyframes.empty()) return false;
  for (const std::size_t i : {std::size_t{0}, keyframes.size() / 2, keyframes.size() - 1}) {
    try {
      if (has_color(sequence.read_color(static_cast<int>(keyframes[i].id)))) return true;
    } catch (const Error&) {
      // Which frames cannot be read is said when it comes to them.
    }
  }
  return false;
}

Colors colors_of(const RecordedMap& map, const FrameImages& images,
                 const std::function<void(const std::string&)>& warn) {
  Colors colors;
  bool has_failed = false;
  for (const protocol::Keyframe& keyframe : map.keyframes) {
    try {
      const Image<Rgb> image = images.rectified(keyframe.id, false);
      colors[keyframe.id] = colors_at(image, pixels_of(keyframe, images.camera(), images.motion(keyframe.id)));
    } catch (const Error& error) {
      if (!has_failed) warn(std::string("points of the viewer stay grey: ") + error.what());
      has_failed = true;
    }
  }
  return colors;
}

/// The messages with the colours put into those of the keyframes.
Bytes with_colors(const Bytes& recording, const Colors& colors) {
  Bytes result;
  for (const protocol::Message& message : protocol::split(recording, "recording")) {
    const std::span<const std::uint8_t> bytes = protocol::whole(message);
    if (message.type != protocol::MessageType::kKeyframe) {
      result.insert(result.end(), bytes.begin(), bytes.end());
      continue;
    }
    protocol::Keyframe keyframe = protocol::decode_keyframe(message.payload, "recording");
    const auto found = colors.find(keyframe.id);
    if (found != colors.end() && found->second.size() == keyframe.points.size()) keyframe.colors = found->second;
    const Bytes colored = encode(keyframe);
    result.insert(result.end(), colored.begin(), colored.end());
  }
  return result;
}

}  // namespace

std::vector<Rgb> colors_at(const Image<Rgb>& image, const std::vector<Eigen::Vector2d>& pixels) {
  std::vector<Rgb> colors;
  colors.reserve(pixels.size());
  for (const Eigen::Vector2d& pixel : pixels) {
    if (!pixel.allFinite()) {
      colors.push_back({});
      continue;
    }
    const double x = std::clamp(pixel.x(), 0.0, image.width() - 1.0),
                 y = std::clamp(pixel.y(), 0.0, image.height() - 1.0);
    colors.push_back(image(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))));
  }
  return colors;
}

Bytes colored_recording(const Bytes& recording, const Dataset& sequence, const Calibration& calibration,
                        const PinholeIntrinsics& camera, const Trajectory& trajectory, double metres_per_unit,
                        const std::function<void(const std::string&)>& warn) {
  if (sequence.size() == 0) return recording;
  RecordedMap map = decode_recorded_map(recording, "recording");
  if (!any_has_color(sequence, map.keyframes)) return recording;
  scale_map(metres_per_unit, map);
  const PlacedMap placed{map, map.corrected};
  const FrameImages images(sequence, calibration, camera, placed, posed_frames(trajectory, sequence));
  return with_colors(recording, colors_of(map, images, warn));
}

}  // namespace ldso
