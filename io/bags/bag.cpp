#include "io/bags/bag.h"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// What a file of `count` bytes or more begins with.
std::string first_bytes(const fs::path& path, std::size_t count) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

bool is_bag_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path metadata = folder / "metadata.yaml";
  if (!fs::is_regular_file(metadata, error)) return false;
  return first_bytes(metadata, 256).find("rosbag2_bagfile_information") != std::string::npos;
}

/// rosbag2 packs whole files if asked to.
bool is_packed(const fs::path& path) { return path.extension() == ".zstd" && has_bag_extension(path.stem()); }

}  // namespace

bool has_bag_extension(const fs::path& path) {
  const std::string ending = to_lower(path.extension().string());
  return ending == ".bag" || ending == ".mcap" || ending == ".db3";
}

bool is_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return is_bag_folder(path);
  if (has_bag_extension(path) || is_packed(path)) return fs::is_regular_file(path, error);
  const std::string start = first_bytes(path, kSqliteMagic.size());
  return start.starts_with("#ROSBAG V") || start.starts_with(kMcapMagic) || start == kSqliteMagic;
}

std::unique_ptr<Bag> open_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return open_bag_folder(path);
  const std::string start = first_bytes(path, kSqliteMagic.size());
  if (start.starts_with(kRos1BagMagic)) return open_ros1_bag(path);
  if (start.starts_with(kMcapMagic)) return open_mcap_bag(path);
  if (start == kSqliteMagic) return open_sqlite_bag(path);
  if (start.starts_with("#ROSBAG V"))
    throw Error(path.string(), "is a bag of an old format, of which 2.0 alone is read", "`rosbag fix` brings it there");
  if (is_packed(path)) {
    throw Error(path.string(), "the bag is packed as a whole", "`zstd -d " + path.filename().string() + "` unpacks it");
  }
  throw Error(path.string(), start.empty() ? "the bag is empty or cannot be read" : "is no bag, whatever its name says",
              "bags of ROS 1 (format 2.0), MCAP and SQLite bags of ROS 2 are read");
}

std::string plain_type(std::string type) {
  const std::size_t middle = type.find("/msg/");
  if (middle != std::string::npos) type.erase(middle, 4);
  return type;
}

}  // namespace ldso
