#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/node_output.h"
#include "core/slam_node.h"
#include "ldso/io/ros_types.h"

namespace ldso::ros {

// Messages have the same fields in ROS 1 and ROS 2, and other types: these templates read and fill either.

/// Of sensor_msgs/Image, which stays where it is.
template <class MessagePointer>
NodeImage image_of(const MessagePointer& message, std::int64_t stamp_ns) {
  NodeImage result;
  result.stamp_ns = stamp_ns;
  result.frame = message->header.frame_id;
  result.image.width = message->width;
  result.image.height = message->height;
  result.image.encoding = message->encoding;
  result.image.is_big_endian = message->is_bigendian != 0;
  result.image.step = message->step;
  result.image.data = message->data.data();
  result.image.size = message->data.size();
  result.owner = std::make_shared<MessagePointer>(message);
  return result;
}

/// Of sensor_msgs/CompressedImage.
template <class MessagePointer>
NodeImage compressed_image_of(const MessagePointer& message, std::int64_t stamp_ns) {
  NodeImage result;
  result.stamp_ns = stamp_ns;
  result.frame = message->header.frame_id;
  result.compressed_format = message->format.empty() ? "unknown" : message->format;
  result.image.data = message->data.data();
  result.image.size = message->data.size();
  result.owner = std::make_shared<MessagePointer>(message);
  return result;
}

/// Of sensor_msgs/CameraInfo, whose matrices ROS 1 calls D, K and P, ROS 2 d, k and p.
template <class Message, class Coefficients, class Matrix3, class Matrix34>
RosCameraInfo info_of(const Message& message, const Coefficients& D, const Matrix3& K, const Matrix34& P) {
  RosCameraInfo info;
  info.frame = message.header.frame_id;
  info.width = message.width;
  info.height = message.height;
  info.model = message.distortion_model;
  info.distortion.assign(D.begin(), D.end());
  std::copy(K.begin(), K.end(), info.K.begin());
  std::copy(P.begin(), P.end(), info.P.begin());
  info.binning_x = message.binning_x;
  info.binning_y = message.binning_y;
  info.roi_x = message.roi.x_offset;
  info.roi_y = message.roi.y_offset;
  info.roi_width = message.roi.width;
  info.roi_height = message.roi.height;
  return info;
}

template <class Point, class Quaternion>
void set_pose(const NodePose& pose, Point& point, Quaternion& quaternion) {
  point.x = pose.position[0];
  point.y = pose.position[1];
  point.z = pose.position[2];
  quaternion.x = pose.orientation[0];
  quaternion.y = pose.orientation[1];
  quaternion.z = pose.orientation[2];
  quaternion.w = pose.orientation[3];
}

/// geometry_msgs/PoseStamped.
template <class Message, class Time>
Message pose_message(const NodePose& pose, const Time& stamp, const std::string& map_frame) {
  Message message;
  message.header.stamp = stamp;
  message.header.frame_id = map_frame;
  set_pose(pose, message.pose.position, message.pose.orientation);
  return message;
}

/// geometry_msgs/TransformStamped.
template <class Message, class Time>
Message transform_message(const NodePose& pose, const Time& stamp, const std::string& map_frame) {
  Message message;
  message.header.stamp = stamp;
  message.header.frame_id = map_frame;
  message.child_frame_id = pose.camera_frame;
  set_pose(pose, message.transform.translation, message.transform.rotation);
  return message;
}

/// sensor_msgs/PointCloud2 of x, y, z and intensity, 32 bits each.
template <class Message, class Field, class Time>
Message cloud_message(const std::vector<NodePoint>& points, const Time& stamp, const std::string& map_frame) {
  static_assert(sizeof(NodePoint) == 4 * sizeof(float), "points are copied as they are");
  Message message;
  message.header.stamp = stamp;
  message.header.frame_id = map_frame;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points.size());
  for (const char* name : {"x", "y", "z", "intensity"}) {
    Field field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(message.fields.size() * sizeof(float));
    field.datatype = Field::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = sizeof(NodePoint);
  message.row_step = message.point_step * message.width;
  message.is_dense = true;
  message.data.resize(message.row_step);
  if (!points.empty()) std::memcpy(message.data.data(), points.data(), message.data.size());
  return message;
}

/// diagnostic_msgs/DiagnosticArray.
template <class Array, class Status, class KeyValue, class Time>
Array diagnostics_message(const NodeStatus& status, const Time& now, const std::string& node) {
  Array array;
  array.header.stamp = now;
  Status message;
  message.level = static_cast<decltype(message.level)>(status.level);
  message.message = status.message;
  message.name = node + ": tracking";
  message.hardware_id = "none";
  for (const auto& [name, value] : status.figures) {
    KeyValue figure;
    figure.key = name;
    figure.value = value;
    message.values.push_back(figure);
  }
  array.status.push_back(message);
  return array;
}

}  // namespace ldso::ros
