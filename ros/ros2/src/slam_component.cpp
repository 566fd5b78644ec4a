// The node of ROS 2, composable: messages in and out; what happens in between is SlamNode.

#include <chrono>
#include <cstdint>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <functional>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <image_transport/image_transport.hpp>
#include <memory>
#include <nav_msgs/msg/path.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <tf2_ros/transform_broadcaster.h>
#include <vector>

#include "core/messages.h"
#include "core/slam_node.h"

namespace ldso::ros {
namespace {

using diagnostic_msgs::msg::DiagnosticArray;
using geometry_msgs::msg::PoseStamped;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;
using sensor_msgs::msg::PointCloud2;

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::chrono::milliseconds kDiagnosticsPeriod{500};

builtin_interfaces::msg::Time time_of(std::int64_t ns) {
  builtin_interfaces::msg::Time time;
  time.sec = static_cast<std::int32_t>(ns / kNanosecondsPerSecond);
  time.nanosec = static_cast<std::uint32_t>(ns % kNanosecondsPerSecond);
  return time;
}

std::int64_t ns_of(const builtin_interfaces::msg::Time& time) {
  return std::int64_t{time.sec} * kNanosecondsPerSecond + time.nanosec;
}

/// Each parameter is declared as text with what it is by default, and may be given as any type.
NodeOptions read_options(rclcpp::Node& node) {
  NodeOptions options;
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.dynamic_typing = true;
  descriptor.read_only = true;
  for (const NodeParameter& parameter : node_parameters()) {
    descriptor.description = parameter.description.empty() ? "see `ldso settings`" : parameter.description;
    const rclcpp::ParameterValue value =
        node.declare_parameter(parameter.name, rclcpp::ParameterValue(parameter.value), descriptor);
    const std::string text = rclcpp::to_string(value);
    const bool is_default = text == parameter.value;
    if (!is_default) set_parameter(options, parameter.name, text);
  }
  options.image_topic = node.get_node_topics_interface()->resolve_topic_name(options.image_topic);
  return options;
}

/// Publishes what the node finds: ~/pose, ~/path, ~/cloud, /tf, /diagnostics.
class Ros2Output final : public NodeOutput {
 public:
  Ros2Output(rclcpp::Node& node, const NodeOptions& options)
      : node_(node),
        options_(options),
        pose_(node.create_publisher<PoseStamped>("~/pose", rclcpp::QoS(100))),
        path_(node.create_publisher<nav_msgs::msg::Path>("~/path", rclcpp::QoS(1).transient_local())),
        cloud_(node.create_publisher<PointCloud2>("~/cloud", rclcpp::QoS(1).transient_local())),
        diagnostics_(node.create_publisher<DiagnosticArray>("/diagnostics", rclcpp::QoS(10))),
        broadcaster_(node) {}

  void pose(const NodePose& pose) override {
    const auto stamp = time_of(pose.stamp_ns);
    pose_->publish(pose_message<PoseStamped>(pose, stamp, options_.map_frame));
    if (!options_.publish_tf || pose.camera_frame.empty()) return;
    broadcaster_.sendTransform(
        transform_message<geometry_msgs::msg::TransformStamped>(pose, stamp, options_.map_frame));
  }

  void map(std::int64_t stamp_ns, const std::vector<NodePose>& path, const std::vector<NodePoint>& points) override {
    nav_msgs::msg::Path message;
    message.header.frame_id = options_.map_frame;
    message.header.stamp = time_of(stamp_ns);
    for (const NodePose& pose : path)
      message.poses.push_back(pose_message<PoseStamped>(pose, time_of(pose.stamp_ns), options_.map_frame));
    path_->publish(message);
    cloud_->publish(
        cloud_message<PointCloud2, sensor_msgs::msg::PointField>(points, time_of(stamp_ns), options_.map_frame));
  }

  void log(LogLevel level, const std::string& text) override {
    if (level == LogLevel::kWarning) {
      RCLCPP_WARN(node_.get_logger(), "%s", text.c_str());
    } else {
      RCLCPP_INFO(node_.get_logger(), "%s", text.c_str());
    }
  }

  void status(const NodeStatus& status) {
    diagnostics_->publish(diagnostics_message<DiagnosticArray, diagnostic_msgs::msg::DiagnosticStatus,
                                              diagnostic_msgs::msg::KeyValue>(
        status, time_of(node_.now().nanoseconds()), node_.get_fully_qualified_name()));
  }

 private:
  rclcpp::Node& node_;
  const NodeOptions& options_;
  rclcpp::Publisher<PoseStamped>::SharedPtr pose_;
  rclcpp::Publisher<nav_msgs::msg::Path>::SharedPtr path_;
  rclcpp::Publisher<PointCloud2>::SharedPtr cloud_;
  rclcpp::Publisher<DiagnosticArray>::SharedPtr diagnostics_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace

class SlamComponent final : public rclcpp::Node {
 public:
  explicit SlamComponent(const rclcpp::NodeOptions& node_options)
      : rclcpp::Node("ldso", node_options), options_(read_options(*this)), output_(*this, options_),
        slam_(options_, output_) {
    subscribe_to_images();
    infos_ = create_subscription<CameraInfo>(
        info_topic(options_), rclcpp::SensorDataQoS(),
        [this](CameraInfo::ConstSharedPtr info) { slam_.on_camera_info(info_of(*info, info->d, info->k, info->p)); });
    reset_ = create_service<std_srvs::srv::Trigger>(
        "~/reset", [this](const std::shared_ptr<std_srvs::srv::Trigger::Request>,
                          const std::shared_ptr<std_srvs::srv::Trigger::Response> response) {
          slam_.reset();
          response->success = true;
        });
    timer_ = create_wall_timer(kDiagnosticsPeriod, [this] { output_.status(slam_.status()); });
  }

  ~SlamComponent() override { slam_.finish(); }

 private:
  /// By image_transport; compressed ones as they are, which needs no plugin of it.
  void subscribe_to_images() {
    if (options_.transport == "compressed") {
      compressed_ = create_subscription<CompressedImage>(
          options_.image_topic + "/compressed", quality(), [this](CompressedImage::ConstSharedPtr message) {
            slam_.on_image(compressed_image_of(message, ns_of(message->header.stamp)));
          });
      return;
    }
    images_ = image_transport::create_subscription(
        this, options_.image_topic,
        [this](const Image::ConstSharedPtr& message) {
          slam_.on_image(image_of(message, ns_of(message->header.stamp)));
        },
        options_.transport, quality().get_rmw_qos_profile());
  }

  /// Cameras publish without a guarantee. Where no image may be lost, none may on the way either.
  rclcpp::QoS quality() const {
    if (options_.queue_size == 0) return rclcpp::QoS(rclcpp::KeepAll()).reliable();
    return rclcpp::SensorDataQoS().keep_last(static_cast<std::size_t>(options_.queue_size) + 1);
  }

  const NodeOptions options_;
  Ros2Output output_;
  SlamNode slam_;
  image_transport::Subscriber images_;
  rclcpp::Subscription<CompressedImage>::SharedPtr compressed_;
  rclcpp::Subscription<CameraInfo>::SharedPtr infos_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr reset_;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ldso::ros

RCLCPP_COMPONENTS_REGISTER_NODE(ldso::ros::SlamComponent)
