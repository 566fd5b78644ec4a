#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ldso/log.h"

namespace ldso::ros {

// What nodes publish, in plain types. Headers of core/ that nodes include are C++17, as are those of ROS 1.

/// Of the camera in the frame of the map, at the time of an image's header [ns].
struct NodePose {
  std::int64_t stamp_ns = 0;
  std::string camera_frame;             ///< In tf.
  std::array<double, 3> position{};     ///< [map units]
  std::array<double, 4> orientation{};  ///< Quaternion x, y, z, w.
};

struct NodePoint {
  float x = 0, y = 0, z = 0;  ///< In the frame of the map [map units].
  float intensity = 0;        ///< 0..255
};

/// Of diagnostic_msgs/DiagnosticStatus.
enum class NodeLevel : std::uint8_t { kOk = 0, kWarning = 1, kError = 2 };

/// How a node is doing.
struct NodeStatus {
  NodeLevel level = NodeLevel::kWarning;
  std::string message;                                       ///< "tracking", "waiting for camera_info", ...
  std::vector<std::pair<std::string, std::string>> figures;  ///< By name.
};

/// Where a node publishes: implemented once for ROS 1 and once for ROS 2. Called from any thread.
class NodeOutput {
 public:
  virtual ~NodeOutput() = default;
  NodeOutput(const NodeOutput&) = delete;
  NodeOutput& operator=(const NodeOutput&) = delete;

  /// Of each image that was tracked.
  virtual void pose(const NodePose& pose) = 0;
  /// Of all images so far, as now estimated, and the points; after loops were closed as well.
  virtual void map(std::int64_t stamp_ns, const std::vector<NodePose>& path, const std::vector<NodePoint>& points) = 0;
  virtual void log(LogLevel level, const std::string& text) = 0;

 protected:
  NodeOutput() = default;
};

}  // namespace ldso::ros
