#pragma once

// A sparse model as COLMAP's files, which Nerfstudio and programs for Gaussian splatting read as well.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/rgb.h"
#include "ldso/se3.h"

namespace ldso {

/// Where an image shows a point.
struct ColmapObservation {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< Pixel centres at integers, as everywhere here.
  std::size_t point = 0;                            ///< Index of the point in the model.
};

struct ColmapImage {
  std::string name;  ///< Relative to the folder of the images.
  SE3d T_world_camera;
  std::vector<ColmapObservation> observations;
};

struct ColmapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::uint8_t intensity = 0;
  std::optional<Rgb> color = std::nullopt;  ///< In place of the intensity, if known.
  double error = -1;  ///< Mean distance of where it is seen from where it should be [px]; -1: unknown.
};

/// All images are of one camera.
struct ColmapModel {
  CameraCalibration camera;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;
};

/// The camera's line of cameras.txt without its number: "FOV 640 480 ...". COLMAP has the same lens models under other
/// names (PINHOLE, FOV, OPENCV, OPENCV_FISHEYE); its pixel centres are at halves.
std::string colmap_camera(const CameraCalibration& camera);

/// Writes cameras, images and points3D to the folder, which is created: as .bin, which COLMAP takes first, and as .txt
/// for people and simple programs; both say the same. Points that no image shows are left out: COLMAP would not read
/// them. Throws Error if an image has a name with a blank or line break, which the text format cannot hold, or if a
/// file cannot be written.
void write_colmap_model(const std::filesystem::path& folder, const ColmapModel& model);

}  // namespace ldso
