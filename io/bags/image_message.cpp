#include "io/bags/image_message.h"

#include <string_view>

#include "io/bags/message_header.h"
#include "io/bags/ros_image.h"

namespace ldso {
namespace {

constexpr std::string_view kRawType = "sensor_msgs/Image";
constexpr std::string_view kCompressedType = "sensor_msgs/CompressedImage";

std::vector<std::uint8_t> raw_image(WireReader& message, const std::string& where) {
  RosImage image;
  image.height = message.number<std::uint32_t>();
  image.width = message.number<std::uint32_t>();
  image.encoding = message.text();
  image.is_big_endian = message.number<std::uint8_t>() != 0;
  image.step = message.number<std::uint32_t>();
  const std::span<const std::uint8_t> data = message.sequence();
  image.data = data.data();
  image.size = data.size();
  return pnm_file_of(image, where);
}

std::vector<std::uint8_t> compressed_image(WireReader& message, const std::string& where) {
  check_compressed(message.text(), where);
  const std::span<const std::uint8_t> data = message.sequence();
  return {data.begin(), data.end()};
}

}  // namespace

bool has_images(const BagTopic& topic) {
  if (topic.format == MessageFormat::kOther || topic.name.ends_with("/compressedDepth")) return false;
  return topic.type == kRawType || topic.type == kCompressedType;
}

std::vector<std::uint8_t> image_file_of(std::span<const std::uint8_t> message, const BagTopic& topic,
                                        const std::string& where) {
  WireReader reader(message, topic.format, where);
  read_header(reader, topic.format);
  return topic.type == kRawType ? raw_image(reader, where) : compressed_image(reader, where);
}

}  // namespace ldso
