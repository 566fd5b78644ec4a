#pragma once

// What ldso makes of images and calibrations of ROS: sensor_msgs/Image, CompressedImage and CameraInfo.

#include <cstdint>
#include <span>
#include <string>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/io/ros_types.h"

namespace ldso {

/// Grey levels in 0..255: mono, rgb, bgr, rgba, bgra and bayer of 8 and 16 bits, and the luma of yuv422 (uyvy, yuyv),
/// nv12, nv21 and nv24. Those of 16 bits use `bits` of them. Throws Error with `where` if the encoding is another one,
/// or if there are fewer bytes than pixels.
Image<float> grey_image(const RosImage& image, const std::string& where, int bits = 16);
/// Of the bytes of a sensor_msgs/CompressedImage; `format` is its field. Throws Error likewise.
Image<float> grey_image(std::span<const std::uint8_t> data, const std::string& format, const std::string& where,
                        int bits = 16);

/// The camera that takes the images: K and D with binning and region of interest, or P of rectified ones. Rectified by
/// `crop`, if it distorts. `where` is what the description and messages call it. Throws Error if it was not calibrated
/// or makes no sense.
Calibration to_calibration(const RosCameraInfo& info, bool is_rectified, const std::string& where);

/// Whether images on a topic are rectified, by its name: "/camera/image_rect_color" are.
bool has_rectified_images(const std::string& topic);

/// The camera_info of the images on a topic, by the convention: "/camera/camera_info" of "/camera/image_raw".
std::string camera_info_topic(const std::string& image_topic);

}  // namespace ldso
