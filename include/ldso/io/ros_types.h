#pragma once

// Images and calibrations as ROS 1 and ROS 2 have them in memory, field by field, so that neither of both is needed
// here. This header is C++17: those of ROS 1 do not compile as C++20.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ldso {

/// sensor_msgs/Image.
struct RosImage {
  std::uint32_t width = 0, height = 0;  ///< [px]
  std::string encoding;                 ///< One of sensor_msgs/image_encodings: "mono8", "bayer_rggb8", ...
  bool is_big_endian = false;           ///< Of pixels of 16 bits.
  std::size_t step = 0;                 ///< Bytes from one row to the next; 0: no gap.
  const std::uint8_t* data = nullptr;   ///< Somebody else's.
  std::size_t size = 0;                 ///< Of data.
};

/// sensor_msgs/CameraInfo. Matrices by rows, pixel centres at integers; they are of the whole sensor.
struct RosCameraInfo {
  std::string frame;                           ///< Of its header.
  std::uint32_t width = 0, height = 0;         ///< [px]
  std::string model;                           ///< "plumb_bob", "rational_polynomial", "equidistant"
  std::vector<double> distortion;              ///< D
  std::array<double, 9> K{};                   ///< All zero: not calibrated.
  std::array<double, 12> P{};                  ///< Of the rectified images.
  std::uint32_t binning_x = 0, binning_y = 0;  ///< Pixels that became one; 0 counts as 1.
  std::uint32_t roi_x = 0, roi_y = 0, roi_width = 0, roi_height = 0;  ///< Of the sensor; width 0: all of it.
};

}  // namespace ldso
