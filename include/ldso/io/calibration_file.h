#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include <Eigen/Core>

#include "ldso/calibration.h"

namespace ldso {

/// Reads a camera.txt of four lines (blank lines and lines that begin with '#' do not count):
///   1. the camera: `fx fy cx cy omega` or `FOV fx fy cx cy omega`, `Pinhole fx fy cx cy 0`,
///      `RadTan fx fy cx cy k1 k2 p1 p2` with perhaps `k3` or `k3 k4 k5 k6`, `KannalaBrandt` or `EquiDistant fx fy cx
///      cy k1 k2 k3 k4`, `DoubleSphere fx fy cx cy xi alpha`, `EUCM fx fy cx cy alpha beta`
///   2. width and height of the images
///   3. `crop`, `full`, `none` or the wanted intrinsics `fx fy cx cy 0`
///   4. width and height of the rectified images
/// Intrinsics with cx and cy below 1 are relative to the image size, f * size and c * size - 0.5; others are in pixels.
/// Files of other programs are read as well: Kalibr's camchain, ROS' camera_info, OpenCV's FileStorage, ORB-SLAM's
/// settings, COLMAP's cameras.txt, Basalt's json, KITTI's calib_cam_to_cam.txt, nerfstudio's transforms.json; they are
/// rectified by `crop` at the size of the images. Behind the path of one that holds several cameras may stand which is
/// wanted: `camchain.yaml:cam1` or `camchain.yaml:1`, counted from 0; without, it is the first.
/// `description` says which was read. Throws Error naming file, line and what is expected.
Calibration read_camera_calibration(const std::filesystem::path& path);

/// The same as text: what read_camera_calibration() reads, in absolute intrinsics to the last bit.
std::string camera_file_text(const Calibration& calibration);

/// As camera.txt names it: "RadTan".
const char* model_name(CameraModelKind kind);

/// pcalib.txt: 256 values of the inverse response that nowhere decrease; scaled to 0..255, equal neighbours are moved
/// apart by one rounding step. Throws Error.
std::array<float, 256> read_inverse_response(const std::filesystem::path& path);

/// Sets response and vignette from `folder`/pcalib.txt and `folder`/vignette.png, where they exist.
void read_photometric_calibration(const std::filesystem::path& folder, Calibration& calibration);

/// KITTI's calib.txt: the 3x4 projection matrices by name ("P0"). Throws Error if it contains none.
std::map<std::string, Eigen::Matrix<double, 3, 4>> read_kitti_calibration(const std::filesystem::path& path);

/// A short text: "FOV 1280x1024 -> crop 640x480".
std::string describe(const CameraCalibration& camera, const Rectification& rectification);

}  // namespace ldso
