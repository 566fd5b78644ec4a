#include "output/transforms_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/text/json_text.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kHalfPixel = 0.5;

/// Camera to world; the camera's axes are x right, y up, z backward, as in OpenGL.
Json pose_json(const SE3d& T_world_camera) {
  Eigen::Matrix4d T = T_world_camera.matrix();
  T.block<3, 2>(0, 1) *= -1;
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
  return rows;
}

/// Lens and coefficients; null if the format has none like it.
Json lens_json(const CameraCalibration& camera) {
  const auto& d = camera.distortion;
  const auto& more = camera.more_distortion;
  switch (camera.model) {
    case CameraModelKind::kPinhole:
      return {{"camera_model", "OPENCV"}, {"k1", 0.0}, {"k2", 0.0}, {"p1", 0.0}, {"p2", 0.0}};
    case CameraModelKind::kRadTan:
      if (more[1] != 0 || more[2] != 0 || more[3] != 0) return {};
      return {{"camera_model", "OPENCV"}, {"k1", d[0]}, {"k2", d[1]}, {"p1", d[2]}, {"p2", d[3]}, {"k3", more[0]}};
    case CameraModelKind::kKannalaBrandt:
      return {{"camera_model", "OPENCV_FISHEYE"}, {"k1", d[0]}, {"k2", d[1]}, {"k3", d[2]}, {"k4", d[3]}};
    default:
      return {};
  }
}

/// instant-ngp's unit cube has to hold the cameras, whatever the unit of the map: position * scale + offset. Others
/// scale by themselves and do not read these.
Json cube_json(const ColmapModel& model) {
  Eigen::Vector3d least = Eigen::Vector3d::Zero(), most = least;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const Eigen::Vector3d& p = model.images[i].T_world_camera.translation();
    least = i == 0 ? p : least.cwiseMin(p).eval();
    most = i == 0 ? p : most.cwiseMax(p).eval();
  }
  const double side = (most - least).maxCoeff();
  const double scale = side > 0 ? 1 / side : 1;
  const Eigen::Vector3d offset = Eigen::Vector3d::Constant(0.5) - scale * 0.5 * (least + most);
  return {{"scale", scale}, {"offset", {offset.x(), offset.y(), offset.z()}}, {"aabb_scale", 16}};
}

}  // namespace

bool has_transforms_lens(const CameraCalibration& camera) { return !lens_json(camera).is_null(); }

void write_transforms_json(const std::filesystem::path& path, const ColmapModel& model, const std::string& images,
                           const std::string& cloud) {
  const CameraCalibration& camera = model.camera;
  Json json = lens_json(camera);
  if (json.is_null()) throw Error(path.string(), "the format has no lens like this one", "export --images rectified");
  json.update({{"w", camera.width},
               {"h", camera.height},
               {"fl_x", camera.fx},
               {"fl_y", camera.fy},
               {"cx", camera.cx + kHalfPixel},
               {"cy", camera.cy + kHalfPixel}});
  json.update(cube_json(model));
  json["ply_file_path"] = cloud;
  json["frames"] = Json::array();
  for (const ColmapImage& image : model.images) {
    json["frames"].push_back(
        {{"file_path", images + "/" + image.name}, {"transform_matrix", pose_json(image.T_world_camera)}});
  }
  write_file(path, json_text(json, 1) + "\n");
}

}  // namespace ldso
