#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ldso/calibration.h"

namespace ldso {

// One reader for each kind of file: each takes its path and gives one of the cameras in it, counted from 0. All throw
// Error if there is no such camera.

struct ForeignCamera {
  CameraCalibration camera;
  std::string kind;   ///< "Kalibr camchain, cam0", for messages.
  std::string where;  ///< File and line.
  int cameras = 1;    ///< That the file holds.
};

/// Throws Error if `camera` is none of the `cameras` that a file holds.
void check_camera(int camera, int cameras, const std::string& where);

/// Width and height, if they are an image size. Throws Error with `where` if they are none.
void set_size(CameraCalibration& camera, double width, double height, const std::string& where);
/// fx, fy, cx, cy in pixels with centres at integers.
void set_intrinsics(CameraCalibration& camera, double fx, double fy, double cx, double cy, const std::string& where);

/// Kalibr, ROS, OpenCV, ORB-SLAM or EuRoC.
ForeignCamera read_yaml_camera(const std::filesystem::path& path, int camera);
/// OpenCV's FileStorage.
ForeignCamera read_xml_camera(const std::filesystem::path& path, int camera);
/// Basalt or nerfstudio.
ForeignCamera read_json_camera(const std::filesystem::path& path, int camera);

bool is_colmap_cameras(const std::filesystem::path& path);
ForeignCamera read_colmap_camera(const std::filesystem::path& path, int camera);

bool is_kitti_calibration(const std::filesystem::path& path);
ForeignCamera read_kitti_camera(const std::filesystem::path& path, int camera);

/// What OpenCV writes of a camera, as YAML or XML.
struct OpenCvCamera {
  double width = 0, height = 0;
  std::vector<double> matrix, distortion;
  bool is_fisheye = false;
};
CameraCalibration to_camera(const OpenCvCamera& values, const std::string& where);

}  // namespace ldso
