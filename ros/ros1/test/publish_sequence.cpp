// publish_sequence FOLDER PATH: publishes a sequence as a camera would, on /camera/image_raw with its camera_info, waits
// until the node ldso has processed all of it, and writes the path that it published last to PATH (TUM format). What
// came of the other topics is printed: "poses N cloud N tf N".

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "ros1/test/sequence_reader.h"

namespace {

constexpr double kPatience = 120;  // [s]
constexpr double kBegin = 1000;    // Times of ROS are not zero [s].

/// What the node published.
struct Received {
  int poses = 0, transforms = 0, processed = 0;
  unsigned points = 0;
  nav_msgs::Path path;

  void diagnostics(const diagnostic_msgs::DiagnosticArray& message) {
    for (const auto& status : message.status) {
      for (const auto& value : status.values) {
        if (value.key == "processed") processed = std::stoi(value.value);
      }
    }
  }
};

sensor_msgs::CameraInfo message_of(const ldso::RosCameraInfo& info) {
  sensor_msgs::CameraInfo message;
  message.header.frame_id = "camera";
  message.width = info.width;
  message.height = info.height;
  message.distortion_model = info.model;
  message.D = info.distortion;
  std::copy(info.K.begin(), info.K.end(), message.K.begin());
  return message;
}

sensor_msgs::Image message_of(const ldso::ros::SequenceReader::Frame& frame) {
  sensor_msgs::Image message;
  message.header.stamp = ros::Time(frame.timestamp + kBegin);
  message.header.frame_id = "camera";
  message.width = frame.width;
  message.height = frame.height;
  message.step = frame.width;
  message.encoding = "mono8";
  message.data = frame.grey;
  return message;
}

template <class Condition>
void wait_until(const char* what, const Condition& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (!condition()) {
    if (!ros::ok() || ros::WallTime::now() > end) throw std::runtime_error(std::string(what) + " did not come in time");
    ros::spinOnce();
    ros::WallDuration(0.02).sleep();
  }
}

void write_path(const nav_msgs::Path& path, const char* file) {
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) throw std::runtime_error(std::string(file) + " cannot be written");
  for (const auto& pose : path.poses) {
    const auto& p = pose.pose.position;
    const auto& q = pose.pose.orientation;
    std::fprintf(out, "%.9f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", pose.header.stamp.toSec(), p.x, p.y, p.z, q.x, q.y,
                 q.z, q.w);
  }
  std::fclose(out);
}

void publish(const char* folder, const char* path_file) {
  const ldso::ros::SequenceReader sequence(folder);
  Received received;
  ros::NodeHandle node;
  const auto images = node.advertise<sensor_msgs::Image>("/camera/image_raw", 0);
  const auto infos = node.advertise<sensor_msgs::CameraInfo>("/camera/camera_info", 1, true);
  infos.publish(message_of(sequence.camera()));
  const ros::Subscriber subscribers[] = {
      node.subscribe<geometry_msgs::PoseStamped>("/ldso/pose", 0, [&](const auto&) { ++received.poses; }),
      node.subscribe<tf2_msgs::TFMessage>("/tf", 0, [&](const auto&) { ++received.transforms; }),
      node.subscribe<nav_msgs::Path>("/ldso/path", 0, [&](const auto& message) { received.path = *message; }),
      node.subscribe<sensor_msgs::PointCloud2>("/ldso/cloud", 0, [&](const auto& m) { received.points = m->width; }),
      node.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 0,
                                                       [&](const auto& message) { received.diagnostics(*message); })};
  wait_until("a subscriber of the images", [&] { return images.getNumSubscribers() > 0; });
  for (int i = 0; i < sequence.size(); ++i) images.publish(message_of(sequence.read(i)));
  wait_until("the end of the sequence", [&] { return received.processed == sequence.size(); });
  wait_until("the path", [&] { return !received.path.poses.empty(); });
  write_path(received.path, path_file);
  std::printf("poses %d cloud %u tf %d\n", received.poses, received.points, received.transforms);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "publish_sequence");
  if (argc != 3) return 2;
  try {
    publish(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "publish_sequence: %s\n", error.what());
    return 1;
  }
}
