#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "io/bags/wire_reader.h"

namespace ldso {

// Recordings of ROS: bags of ROS 1 (format 2.0), MCAP files and SQLite bags of ROS 2, read without ROS.

struct BagTopic {
  std::string name;
  std::string type;  ///< As ROS 1 writes it, of ROS 2 as well: "sensor_msgs/Image".
  MessageFormat format = MessageFormat::kOther;
  std::size_t count = 0;  ///< Of its messages.
};

/// Where a message lies.
struct BagMessage {
  std::int64_t time_ns = 0;  ///< When it was recorded.
  std::uint32_t file = 0;    ///< Of a bag of several files.
  std::uint32_t chunk = 0;   ///< Of the file.
  std::uint64_t offset = 0;  ///< In the unpacked chunk, or the row of a table.
};

class Bag {
 public:
  virtual ~Bag() = default;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;

  virtual const std::vector<BagTopic>& topics() const = 0;
  /// Of topics()[topic], in the order in which they were recorded. Throws Error.
  virtual std::vector<BagMessage> messages(std::size_t topic) const = 0;
  /// The first `most` bytes of a serialized message, all if it has no more. Throws Error if it is damaged or cut off.
  virtual std::vector<std::uint8_t> read(const BagMessage& message,
                                         std::size_t most = std::numeric_limits<std::size_t>::max()) const = 0;
  /// What is missing of a bag that is cut off or damaged.
  virtual const std::vector<std::string>& warnings() const = 0;

 protected:
  Bag() = default;
};

/// Whether a file is a bag, by its first bytes or its name, or a folder has the metadata.yaml of one of ROS 2.
bool is_bag(const std::filesystem::path& path);

/// By the name alone.
bool has_bag_extension(const std::filesystem::path& path);

/// Throws Error if it is none, or nothing in it can be read.
std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

// Each format.

inline constexpr std::string_view kRos1BagMagic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path);
std::unique_ptr<Bag> open_mcap_bag(const std::filesystem::path& path);
std::unique_ptr<Bag> open_sqlite_bag(const std::filesystem::path& path);
/// Of a folder with metadata.yaml: its files as one.
std::unique_ptr<Bag> open_bag_folder(const std::filesystem::path& folder);

/// "sensor_msgs/Image" of "sensor_msgs/msg/Image".
std::string plain_type(std::string type);

}  // namespace ldso
