// The node of ROS 1: messages in and out; what happens in between is SlamNode.

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "ros1/ros1_output.h"

namespace ldso::ros {
namespace {

constexpr double kDiagnosticsPeriod = 0.5;  // [s]

/// A parameter's value as text, whatever its type; nothing if it is not set.
std::optional<std::string> parameter_of(const ::ros::NodeHandle& node, const std::string& name) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam(name, value)) return std::nullopt;
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return number_text(static_cast<double>(value));
    default:
      throw std::runtime_error("parameter '" + name + "': it is no text, number or truth value; see ros/README.md");
  }
}

/// Names of ROS 1 have no dots: selection.candidates is the parameter selection/candidates.
NodeOptions read_options(const ::ros::NodeHandle& node) {
  NodeOptions options;
  for (const NodeParameter& parameter : node_parameters()) {
    std::string name = parameter.name;
    std::replace(name.begin(), name.end(), '.', '/');
    if (const auto value = parameter_of(node, name)) set_parameter(options, parameter.name, *value);
  }
  options.image_topic = ::ros::names::resolve(options.image_topic);
  return options;
}

std::int64_t stamp_of(const ::ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

/// Subscriptions of the node; images by image_transport, compressed ones as they are.
class Ros1Input {
 public:
  Ros1Input(const NodeOptions& options, SlamNode& slam) : slam_(slam), transport_(global_) {
    const unsigned queue = options.queue_size == 0 ? 0 : static_cast<unsigned>(options.queue_size) + 1;
    infos_ = global_.subscribe(info_topic(options), 10, &Ros1Input::on_info, this);
    if (options.transport == "compressed") {
      compressed_ = global_.subscribe(options.image_topic + "/compressed", queue, &Ros1Input::on_compressed, this);
    } else {
      images_ = transport_.subscribe(options.image_topic, queue, &Ros1Input::on_image, this,
                                     image_transport::TransportHints(options.transport));
    }
  }

 private:
  void on_info(const sensor_msgs::CameraInfoConstPtr& message) {
    slam_.on_camera_info(info_of(*message, message->D, message->K, message->P));
  }
  void on_image(const sensor_msgs::ImageConstPtr& message) {
    slam_.on_image(image_of(message, stamp_of(message->header.stamp)));
  }
  void on_compressed(const sensor_msgs::CompressedImageConstPtr& message) {
    slam_.on_image(compressed_image_of(message, stamp_of(message->header.stamp)));
  }

  SlamNode& slam_;
  ::ros::NodeHandle global_;
  image_transport::ImageTransport transport_;
  image_transport::Subscriber images_;
  ::ros::Subscriber compressed_, infos_;
};

void run() {
  ::ros::NodeHandle node("~");
  const NodeOptions options = read_options(node);
  Ros1Output output(node, options);
  SlamNode slam(options, output);
  {
    const Ros1Input input(options, slam);
    const boost::function<bool(std_srvs::TriggerRequest&, std_srvs::TriggerResponse&)> on_reset =
        [&](std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
          slam.reset();
          response.success = 1;
          return true;
        };
    const ::ros::ServiceServer reset = node.advertiseService("reset", on_reset);
    const ::ros::WallTimer timer = node.createWallTimer(
        ::ros::WallDuration(kDiagnosticsPeriod), [&](const ::ros::WallTimerEvent&) { output.status(slam.status()); });
    ::ros::spin();
  }
  slam.finish();
}

}  // namespace
}  // namespace ldso::ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "ldso");
  try {
    ldso::ros::run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ldso: %s\n", error.what());
    return 1;
  }
}
