#include "io/bags/camera_info.h"

#include <array>

#include "io/bags/message_header.h"
#include "ldso/error.h"
#include "ldso/io/ros_messages.h"

namespace ldso {
namespace {

constexpr const char* kInfoType = "sensor_msgs/CameraInfo";

/// More coefficients than any lens model has.
constexpr std::uint32_t kMostCoefficients = 64;

template <std::size_t N>
void read_numbers(WireReader& reader, std::array<double, N>& numbers) {
  for (double& number : numbers) number = reader.number<double>();
}

RosCameraInfo read_info(const Bag& bag, const BagMessage& message, const BagTopic& topic, const std::string& where) {
  const std::vector<std::uint8_t> bytes = bag.read(message);
  WireReader reader(bytes, topic.format, where);
  RosCameraInfo info;
  info.frame = read_header(reader, topic.format).frame;
  info.height = reader.number<std::uint32_t>();
  info.width = reader.number<std::uint32_t>();
  info.model = reader.text();
  const auto count = reader.number<std::uint32_t>();
  if (count > kMostCoefficients) throw Error(where, "it announces " + std::to_string(count) + " coefficients", "");
  for (std::uint32_t i = 0; i < count; ++i) info.distortion.push_back(reader.number<double>());
  std::array<double, 9> rotation;
  read_numbers(reader, info.K);
  read_numbers(reader, rotation);
  read_numbers(reader, info.P);
  info.binning_x = reader.number<std::uint32_t>();
  info.binning_y = reader.number<std::uint32_t>();
  info.roi_x = reader.number<std::uint32_t>();
  info.roi_y = reader.number<std::uint32_t>();
  info.roi_height = reader.number<std::uint32_t>();
  info.roi_width = reader.number<std::uint32_t>();
  return info;
}

bool is_same(const RosCameraInfo& a, const RosCameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.model == b.model && a.distortion == b.distortion &&
         a.K == b.K && a.P == b.P;
}

bool is_info(const BagTopic& topic) {
  return topic.type == kInfoType && topic.format != MessageFormat::kOther && topic.count > 0;
}

/// Of the topic with the right name, or of the only one with the right frame.
std::optional<std::size_t> choose_info(const Bag& bag, const std::string& location, const std::string& base,
                                       const std::string& frame) {
  const std::vector<BagTopic>& topics = bag.topics();
  std::vector<std::size_t> of_frame;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (!is_info(topics[i])) continue;
    if (topics[i].name == camera_info_topic(base)) return i;
    if (frame.empty()) continue;
    const RosCameraInfo info = read_info(bag, bag.messages(i).front(), topics[i], location + ":" + topics[i].name);
    if (info.frame == frame) of_frame.push_back(i);
  }
  return of_frame.size() == 1 ? std::optional(of_frame.front()) : std::nullopt;
}

}  // namespace

std::string base_topic(const BagTopic& topic) {
  return topic.type == "sensor_msgs/CompressedImage" ? topic.name.substr(0, topic.name.rfind('/')) : topic.name;
}

std::optional<Calibration> find_camera_info(const Bag& bag, const std::string& location, const std::string& base,
                                            const std::string& frame, std::vector<std::string>& warnings) {
  const std::optional<std::size_t> chosen = choose_info(bag, location, base, frame);
  if (!chosen) return std::nullopt;
  const BagTopic& topic = bag.topics()[*chosen];
  const std::string where = location + ":" + topic.name;
  const std::vector<BagMessage> messages = bag.messages(*chosen);
  const RosCameraInfo first = read_info(bag, messages.front(), topic, where);
  if (first.K[0] == 0) {
    warnings.push_back(where + ": says that the camera is not calibrated; it is not used");
    return std::nullopt;
  }
  if (!is_same(read_info(bag, messages.back(), topic, where), first))
    warnings.push_back(where + ": the calibration changes in the course of the bag; the first is used");
  return to_calibration(first, has_rectified_images(base), where);
}

}  // namespace ldso
