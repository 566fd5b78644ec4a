#pragma once

// What slam_component.cpp uses of ROS 2 (Humble and later), as declarations: where there is no ROS 2, the component is
// compiled against them. Nothing of it works.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#define LDSO_STAND_IN_POINTERS(type)                   \
  using SharedPtr = std::shared_ptr<type>;             \
  using ConstSharedPtr = std::shared_ptr<const type>;

namespace builtin_interfaces::msg {
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
}  // namespace builtin_interfaces::msg

namespace std_msgs::msg {
struct Header {
  builtin_interfaces::msg::Time stamp;
  std::string frame_id;
};
}  // namespace std_msgs::msg

namespace sensor_msgs::msg {
struct Image {
  LDSO_STAND_IN_POINTERS(Image)
  std_msgs::msg::Header header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data;
};
struct CompressedImage {
  LDSO_STAND_IN_POINTERS(CompressedImage)
  std_msgs::msg::Header header;
  std::string format;
  std::vector<std::uint8_t> data;
};
struct RegionOfInterest {
  std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  bool do_rectify = false;
};
struct CameraInfo {
  LDSO_STAND_IN_POINTERS(CameraInfo)
  std_msgs::msg::Header header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  RegionOfInterest roi;
};
struct PointField {
  static constexpr std::uint8_t FLOAT32 = 7;
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};
struct PointCloud2 {
  std_msgs::msg::Header header;
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;
};
}  // namespace sensor_msgs::msg

namespace geometry_msgs::msg {
struct Point {
  double x = 0, y = 0, z = 0;
};
using Vector3 = Point;
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
struct Pose {
  Point position;
  Quaternion orientation;
};
struct Transform {
  Vector3 translation;
  Quaternion rotation;
};
struct PoseStamped {
  std_msgs::msg::Header header;
  Pose pose;
};
struct TransformStamped {
  std_msgs::msg::Header header;
  std::string child_frame_id;
  Transform transform;
};
}  // namespace geometry_msgs::msg

namespace nav_msgs::msg {
struct Path {
  std_msgs::msg::Header header;
  std::vector<geometry_msgs::msg::PoseStamped> poses;
};
}  // namespace nav_msgs::msg

namespace diagnostic_msgs::msg {
struct KeyValue {
  std::string key, value;
};
struct DiagnosticStatus {
  unsigned char level = 0;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};
struct DiagnosticArray {
  std_msgs::msg::Header header;
  std::vector<DiagnosticStatus> status;
};
}  // namespace diagnostic_msgs::msg

namespace std_srvs::srv {
struct Trigger {
  struct Request {};
  struct Response {
    bool success = false;
    std::string message;
  };
};
}  // namespace std_srvs::srv

namespace rcl_interfaces::msg {
struct ParameterDescriptor {
  std::string description;
  bool read_only = false, dynamic_typing = false;
};
}  // namespace rcl_interfaces::msg

struct rmw_qos_profile_t {};

namespace rclcpp {
struct QoSInitialization {};
struct KeepAll : QoSInitialization {};
class QoS {
 public:
  explicit QoS(const QoSInitialization&);
  explicit QoS(std::size_t history_depth);  // In ROS 2 implicit, too.
  QoS& keep_last(std::size_t depth);
  QoS& reliable();
  QoS& transient_local();
  const rmw_qos_profile_t& get_rmw_qos_profile() const;
};
class SensorDataQoS : public QoS {
 public:
  SensorDataQoS();
};

class Logger {};
class Time {
 public:
  std::int64_t nanoseconds() const;
};
class NodeOptions {};

class ParameterValue {
 public:
  ParameterValue();
  explicit ParameterValue(const std::string& value);
};
std::string to_string(const ParameterValue& value);

template <class Message>
class Publisher {
 public:
  LDSO_STAND_IN_POINTERS(Publisher)
  void publish(const Message& message);
};
template <class Message>
class Subscription {
 public:
  LDSO_STAND_IN_POINTERS(Subscription)
};
template <class Type>
class Service {
 public:
  LDSO_STAND_IN_POINTERS(Service)
};
class TimerBase {
 public:
  LDSO_STAND_IN_POINTERS(TimerBase)
};

namespace node_interfaces {
class NodeTopicsInterface {
 public:
  std::string resolve_topic_name(const std::string& name, bool only_expand = false) const;
};
}  // namespace node_interfaces

class Node {
 public:
  Node(const std::string& name, const NodeOptions& options);
  virtual ~Node();

  const ParameterValue& declare_parameter(const std::string& name, const ParameterValue& value,
                                          const rcl_interfaces::msg::ParameterDescriptor& descriptor);
  std::shared_ptr<node_interfaces::NodeTopicsInterface> get_node_topics_interface();
  Logger get_logger() const;
  Time now() const;
  const char* get_fully_qualified_name() const;

  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string& topic, const QoS& qos);
  template <class Message>
  typename Subscription<Message>::SharedPtr create_subscription(
      const std::string& topic, const QoS& qos, std::function<void(std::shared_ptr<const Message>)> callback);
  template <class Type>
  typename Service<Type>::SharedPtr create_service(
      const std::string& name, std::function<void(const std::shared_ptr<typename Type::Request>,
                                                  const std::shared_ptr<typename Type::Response>)>
                                   callback);
  TimerBase::SharedPtr create_wall_timer(std::chrono::milliseconds period, std::function<void()> callback);
};

void stand_in_log(const Logger& logger, const char* pattern, ...);
}  // namespace rclcpp

#define RCLCPP_WARN(...) rclcpp::stand_in_log(__VA_ARGS__)
#define RCLCPP_INFO(...) rclcpp::stand_in_log(__VA_ARGS__)

namespace image_transport {
class Subscriber {
 public:
  using Callback = std::function<void(const sensor_msgs::msg::Image::ConstSharedPtr&)>;
};
Subscriber create_subscription(rclcpp::Node* node, const std::string& base_topic, const Subscriber::Callback& callback,
                               const std::string& transport, rmw_qos_profile_t custom_qos);
}  // namespace image_transport

namespace tf2_ros {
class TransformBroadcaster {
 public:
  explicit TransformBroadcaster(rclcpp::Node& node);
  void sendTransform(const geometry_msgs::msg::TransformStamped& transform);
};
}  // namespace tf2_ros

#define RCLCPP_COMPONENTS_REGISTER_NODE(type) static_assert(std::is_constructible_v<type, rclcpp::NodeOptions>);
