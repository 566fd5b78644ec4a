#include "ldso/io/colmap_model.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "ldso/error.h"
#include "util/bytes.h"
#include "util/format_text.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr double kHalfPixel = 0.5;

struct Lens {
  const char* name;
  std::int32_t id;
  std::size_t distortion;
};

/// By CameraModelKind.
constexpr std::array<Lens, 4> kLenses{{{"PINHOLE", 1, 0}, {"FOV", 7, 1}, {"OPENCV", 4, 4}, {"OPENCV_FISHEYE", 5, 4}}};

/// OPENCV with k3 and the denominator.
constexpr Lens kFullLens{"FULL_OPENCV", 6, 4};

bool has_more_distortion(const CameraCalibration& camera) { return camera.more_distortion != std::array<double, 4>{}; }

const Lens& lens_of(const CameraCalibration& camera) {
  const auto index = static_cast<std::size_t>(camera.model);
  if (index >= kLenses.size())
    throw Error("COLMAP", "it has no camera model for double sphere and EUCM cameras", "export --images rectified");
  return has_more_distortion(camera) ? kFullLens : kLenses[index];
}

std::vector<double> parameters_of(const CameraCalibration& camera) {
  std::vector<double> all{camera.fx, camera.fy, camera.cx + kHalfPixel, camera.cy + kHalfPixel};
  const auto first = camera.distortion.begin();
  all.insert(all.end(), first, first + static_cast<std::ptrdiff_t>(lens_of(camera).distortion));
  if (has_more_distortion(camera)) all.insert(all.end(), camera.more_distortion.begin(), camera.more_distortion.end());
  for (double& value : all) value += 0.0;  // Not -0.
  return all;
}

void append_number(std::string& text, const char* format, double value) {
  text += format_text(format, value + 0.0);  // Not -0.
}

/// A place of a point among the observations of an image; both count from what COLMAP counts them from.
struct TrackElement {
  std::size_t image = 0;
  std::size_t observation = 0;
};

using Track = std::vector<TrackElement>;

/// By point.
std::vector<Track> tracks_of(const ColmapModel& model) {
  std::vector<Track> tracks(model.points.size());
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const auto& observations = model.images[i].observations;
    for (std::size_t k = 0; k < observations.size(); ++k) tracks.at(observations[k].point).push_back({i + 1, k});
  }
  return tracks;
}

void check_names(const ColmapModel& model) {
  for (const ColmapImage& image : model.images) {
    if (!image.name.empty() && image.name.find_first_of(" \t\r\n") == std::string::npos) continue;
    throw Error("images.txt", "an image is named '" + image.name + "', which COLMAP's text format cannot hold",
                "rename it, or export --images rectified");
  }
}

/// World to camera, as COLMAP has poses: quaternion wxyz, translation.
std::array<double, 7> pose_of(const ColmapImage& image) {
  const SE3d T = image.T_world_camera.inverse();
  const Eigen::Quaterniond& q = T.rotation().quaternion();
  const Eigen::Vector3d& t = T.translation();
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

Rgb color_of(const ColmapPoint& point) {
  return point.color.value_or(Rgb{point.intensity, point.intensity, point.intensity});
}

std::string images_text(const ColmapModel& model) {
  std::string text =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME (world to camera), then X Y POINT3D_ID of its points\n";
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    text += std::to_string(i + 1);
    for (const double value : pose_of(image)) append_number(text, " %.12g", value);
    text += " 1 " + image.name + "\n";
    for (std::size_t k = 0; k < image.observations.size(); ++k) {
      const ColmapObservation& seen = image.observations[k];
      append_number(text, k == 0 ? "%.3f" : " %.3f", seen.pixel.x() + kHalfPixel);
      append_number(text, " %.3f ", seen.pixel.y() + kHalfPixel);
      text += std::to_string(seen.point + 1);
    }
    text += '\n';
  }
  return text;
}

std::string points_text(const ColmapModel& model, const std::vector<Track>& tracks) {
  std::string text = "# POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of where it is seen\n";
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (tracks[i].empty()) continue;
    const ColmapPoint& point = model.points[i];
    text += std::to_string(i + 1);
    for (const double value : point.position) append_number(text, " %.9g", value);
    for (const std::uint8_t channel : color_of(point)) text.append(" ").append(std::to_string(channel));
    append_number(text, " %.4g", point.error);
    for (const TrackElement& element : tracks[i])
      text.append(" ").append(std::to_string(element.image)).append(" ").append(std::to_string(element.observation));
    text += '\n';
  }
  return text;
}

Bytes cameras_bytes(const ColmapModel& model) {
  ByteWriter bytes;
  bytes.put(std::uint64_t{1});
  bytes.put(std::uint32_t{1});
  bytes.put(lens_of(model.camera).id);
  bytes.put(static_cast<std::uint64_t>(model.camera.width));
  bytes.put(static_cast<std::uint64_t>(model.camera.height));
  for (const double value : parameters_of(model.camera)) bytes.put(value);
  return bytes.take();
}

Bytes images_bytes(const ColmapModel& model) {
  ByteWriter bytes;
  bytes.put(std::uint64_t{model.images.size()});
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    bytes.put(static_cast<std::uint32_t>(i + 1));
    for (const double value : pose_of(image)) bytes.put(value);
    bytes.put(std::uint32_t{1});
    bytes.put_text(image.name);
    bytes.put(std::uint8_t{0});
    bytes.put(std::uint64_t{image.observations.size()});
    for (const ColmapObservation& seen : image.observations) {
      bytes.put(seen.pixel.x() + kHalfPixel);
      bytes.put(seen.pixel.y() + kHalfPixel);
      bytes.put(std::uint64_t{seen.point + 1});
    }
  }
  return bytes.take();
}

Bytes points_bytes(const ColmapModel& model, const std::vector<Track>& tracks) {
  ByteWriter bytes;
  const auto seen = std::count_if(tracks.begin(), tracks.end(), [](const Track& track) { return !track.empty(); });
  bytes.put(static_cast<std::uint64_t>(seen));
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (tracks[i].empty()) continue;
    const ColmapPoint& point = model.points[i];
    bytes.put(std::uint64_t{i + 1});
    for (const double value : point.position) bytes.put(value);
    bytes.put_bytes(color_of(point));
    bytes.put(point.error);
    bytes.put(std::uint64_t{tracks[i].size()});
    for (const TrackElement& element : tracks[i]) {
      bytes.put(static_cast<std::uint32_t>(element.image));
      bytes.put(static_cast<std::uint32_t>(element.observation));
    }
  }
  return bytes.take();
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::string colmap_camera(const CameraCalibration& camera) {
  std::string text =
      std::string(lens_of(camera).name) + " " + std::to_string(camera.width) + " " + std::to_string(camera.height);
  for (const double value : parameters_of(camera)) append_number(text, " %.12g", value);
  return text;
}

void write_colmap_model(const std::filesystem::path& folder, const ColmapModel& model) {
  check_names(model);
  const std::vector<Track> tracks = tracks_of(model);
  std::error_code error;
  std::filesystem::create_directories(folder, error);  // If that fails, writing the files will say so.
  write_file(folder / "cameras.txt", "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n1 " + colmap_camera(model.camera) + "\n");
  write_file(folder / "images.txt", images_text(model));
  write_file(folder / "points3D.txt", points_text(model, tracks));
  write_bytes(folder / "cameras.bin", cameras_bytes(model));
  write_bytes(folder / "images.bin", images_bytes(model));
  write_bytes(folder / "points3D.bin", points_bytes(model, tracks));
}

}  // namespace ldso
