#include "ldso/io/colmap_model.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "ldso/error.h"
#include "util/format_text.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr double kHalfPixel = 0.5;

/// By CameraModelKind.
struct LensName {
  const char* name;
  std::size_t distortion;
};
constexpr std::array<LensName, 4> kLenses{{{"PINHOLE", 0}, {"FOV", 1}, {"OPENCV", 4}, {"OPENCV_FISHEYE", 4}}};

/// OPENCV with k3 and the denominator.
constexpr const char* kFullLens = "FULL_OPENCV";

bool has_more_distortion(const CameraCalibration& camera) { return camera.more_distortion != std::array<double, 4>{}; }

const LensName& lens_of(const CameraCalibration& camera) {
  const auto index = static_cast<std::size_t>(camera.model);
  if (index < kLenses.size()) return kLenses[index];
  throw Error("COLMAP", "it has no camera model for double sphere and EUCM cameras", "export --images rectified");
}

void append_number(std::string& text, const char* format, double value) {
  text += format_text(format, value + 0.0);  // Not -0.
}

/// A place of a point among the observations of an image; both count from what COLMAP counts them from.
struct TrackElement {
  std::size_t image = 0;
  std::size_t observation = 0;
};

std::string images_text(const ColmapModel& model) {
  std::string text =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME (world to camera), then X Y POINT3D_ID of its points\n";
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    if (image.name.empty() || image.name.find_first_of(" \t\r\n") != std::string::npos) {
      throw Error("images.txt", "an image is named '" + image.name + "', which COLMAP's text format cannot hold",
                  "rename it, or export --images rectified");
    }
    const SE3d T = image.T_world_camera.inverse();
    const Eigen::Quaterniond& q = T.rotation().quaternion();
    const Eigen::Vector3d& t = T.translation();
    text += std::to_string(i + 1);
    for (const double value : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) append_number(text, " %.12g", value);
    text += " 1 " + image.name + "\n";
    for (std::size_t k = 0; k < image.observations.size(); ++k) {
      const ColmapObservation& seen = image.observations[k];
      append_number(text, k == 0 ? "%.2f" : " %.2f", seen.pixel.x() + kHalfPixel);
      append_number(text, " %.2f ", seen.pixel.y() + kHalfPixel);
      text += std::to_string(seen.point + 1);
    }
    text += '\n';
  }
  return text;
}

std::string points_text(const ColmapModel& model) {
  std::vector<std::vector<TrackElement>> tracks(model.points.size());
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const auto& observations = model.images[i].observations;
    for (std::size_t k = 0; k < observations.size(); ++k) tracks.at(observations[k].point).push_back({i + 1, k});
  }
  std::string text = "# POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of where it is seen\n";
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (tracks[i].empty()) continue;
    const ColmapPoint& point = model.points[i];
    const std::string grey = std::string(" ").append(std::to_string(point.intensity));
    text += std::to_string(i + 1);
    for (const double value : {point.position.x(), point.position.y(), point.position.z()})
      append_number(text, " %.9g", value);
    text.append(grey).append(grey).append(grey).append(" -1");
    for (const TrackElement& element : tracks[i])
      text.append(" ").append(std::to_string(element.image)).append(" ").append(std::to_string(element.observation));
    text += '\n';
  }
  return text;
}

}  // namespace

std::string colmap_camera(const CameraCalibration& camera) {
  const LensName& lens = lens_of(camera);
  const bool is_full = has_more_distortion(camera);
  std::string text = std::string(is_full ? kFullLens : lens.name) + " " + std::to_string(camera.width) + " " +
                     std::to_string(camera.height);
  for (const double value : {camera.fx, camera.fy, camera.cx + kHalfPixel, camera.cy + kHalfPixel})
    append_number(text, " %.12g", value);
  for (std::size_t i = 0; i < lens.distortion; ++i) append_number(text, " %.12g", camera.distortion[i]);
  for (const double k : camera.more_distortion) {
    if (is_full) append_number(text, " %.12g", k);
  }
  return text;
}

void write_colmap_model(const std::filesystem::path& folder, const ColmapModel& model) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);  // If that fails, writing the files will say so.
  write_file(folder / "cameras.txt", "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n1 " + colmap_camera(model.camera) + "\n");
  write_file(folder / "images.txt", images_text(model));
  write_file(folder / "points3D.txt", points_text(model));
}

}  // namespace ldso
