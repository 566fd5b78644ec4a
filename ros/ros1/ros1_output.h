#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/messages.h"

namespace ldso::ros {

inline ::ros::Time time_of(std::int64_t ns) {
  ::ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(ns));
  return time;
}

/// Publishes what the node finds: ~pose, ~path, ~cloud, /tf, /diagnostics.
class Ros1Output final : public NodeOutput {
 public:
  Ros1Output(::ros::NodeHandle& node, const NodeOptions& options)
      : options_(options),
        pose_(node.advertise<geometry_msgs::PoseStamped>("pose", 100)),
        path_(node.advertise<nav_msgs::Path>("path", 1, true)),
        cloud_(node.advertise<sensor_msgs::PointCloud2>("cloud", 1, true)),
        diagnostics_(::ros::NodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10)) {}

  void pose(const NodePose& pose) override {
    pose_.publish(pose_message<geometry_msgs::PoseStamped>(pose, time_of(pose.stamp_ns), options_.map_frame));
    if (!options_.publish_tf || pose.camera_frame.empty()) return;
    broadcaster_.sendTransform(
        transform_message<geometry_msgs::TransformStamped>(pose, time_of(pose.stamp_ns), options_.map_frame));
  }

  void map(std::int64_t stamp_ns, const std::vector<NodePose>& path, const std::vector<NodePoint>& points) override {
    nav_msgs::Path message;
    message.header.frame_id = options_.map_frame;
    message.header.stamp = time_of(stamp_ns);
    for (const NodePose& pose : path)
      message.poses.push_back(pose_message<geometry_msgs::PoseStamped>(pose, time_of(pose.stamp_ns), options_.map_frame));
    path_.publish(message);
    cloud_.publish(
        cloud_message<sensor_msgs::PointCloud2, sensor_msgs::PointField>(points, time_of(stamp_ns), options_.map_frame));
  }

  void log(LogLevel level, const std::string& text) override {
    if (level == LogLevel::kWarning) {
      ROS_WARN("%s", text.c_str());
    } else {
      ROS_INFO("%s", text.c_str());
    }
  }

  void status(const NodeStatus& status) {
    diagnostics_.publish(
        diagnostics_message<diagnostic_msgs::DiagnosticArray, diagnostic_msgs::DiagnosticStatus,
                            diagnostic_msgs::KeyValue>(status, ::ros::Time::now(), ::ros::this_node::getName()));
  }

 private:
  const NodeOptions& options_;
  ::ros::Publisher pose_, path_, cloud_, diagnostics_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace ldso::ros
