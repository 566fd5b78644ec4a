#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/node_options.h"
#include "core/node_output.h"
#include "ldso/io/ros_types.h"

namespace ldso::ros {

/// An image that came.
struct NodeImage {
  std::int64_t stamp_ns = 0;          ///< Of the header.
  std::string frame;                  ///< Of the camera, in tf.
  RosImage image;                     ///< Of a compressed one, data and size alone.
  std::string compressed_format;      ///< Of sensor_msgs/CompressedImage; empty: it is a raw one.
  std::shared_ptr<const void> owner;  ///< Keeps the data.
};

/// What the nodes of ROS 1 and ROS 2 have in common: images and calibrations in, on any thread; poses, path and points
/// out, on a thread of its own.
class SlamNode {
 public:
  /// `output` must outlive it. Throws Error if the options make no sense.
  SlamNode(const NodeOptions& options, NodeOutput& output);
  /// finish(), if that was not called.
  ~SlamNode();
  SlamNode(const SlamNode&) = delete;
  SlamNode& operator=(const SlamNode&) = delete;

  /// The first one that makes sense counts; none if the options name a calibration.
  void on_camera_info(const RosCameraInfo& info);
  /// Waits until there is a calibration. An image that is not later than the one before is refused; if it is a second
  /// earlier or more (a bag that is played again), a new run begins.
  void on_image(NodeImage image);
  /// A new run begins with the next image; the one so far is written.
  void reset();
  /// Ends the run: images that wait are processed if none is to be dropped (queue_size 0); then results are written.
  void finish();

  NodeStatus status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// On which topic the camera_info of the node's images is.
std::string info_topic(const NodeOptions& options);

}  // namespace ldso::ros
