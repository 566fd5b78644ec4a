#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/bags/bag.h"
#include "io/bags/unpack.h"

namespace ldso {

// Bags as ROS would write them, for tests.

using Bytes = std::vector<std::uint8_t>;

/// Values one after the other, as messages and records have them.
class WireWriter {
 public:
  explicit WireWriter(MessageFormat format = MessageFormat::kRos1, bool is_big_endian = false);

  template <class T>
  WireWriter& number(T value) {
    align(sizeof(T));
    auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    if (is_big_endian_) std::reverse(raw.begin(), raw.end());
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  WireWriter& text(std::string_view text);
  WireWriter& sequence(std::span<const std::uint8_t> bytes);
  WireWriter& raw(std::span<const std::uint8_t> bytes);
  WireWriter& raw(std::string_view bytes);
  const Bytes& bytes() const { return bytes_; }

 private:
  void align(std::size_t size);

  MessageFormat format_;
  bool is_big_endian_;
  Bytes bytes_;
};

struct TestImage {
  std::int64_t stamp_ns = 0;
  std::string frame = "camera";
  int width = 0, height = 0;
  std::string encoding = "mono8";
  bool is_big_endian = false;
  int step = 0;
  Bytes data;
};
Bytes image_message(const TestImage& image, MessageFormat format, bool is_big_endian = false);
Bytes compressed_message(std::int64_t stamp_ns, const std::string& kind, std::span<const std::uint8_t> file,
                         MessageFormat format);

struct TestInfo {
  std::string frame = "camera";
  int width = 32, height = 24;
  std::string model = "plumb_bob";
  std::vector<double> distortion;
  double fx = 40, fy = 41, cx = 15.5, cy = 11.5;
  double rectified_fx = 38;
  std::uint32_t binning = 0, roi_x = 0, roi_y = 0, roi_width = 0, roi_height = 0;
};
Bytes info_message(const TestInfo& info, MessageFormat format);

struct TestMessage {
  std::string topic, type;
  std::int64_t time_ns = 0;
  Bytes bytes;
};

struct BagLayout {
  Packing packing = Packing::kNone;
  int messages_per_chunk = 3;
  bool has_index = true;   ///< Behind each chunk, and what stands at the end of a file that was closed.
  bool has_chunks = true;  ///< Of MCAP.
};
void write_ros1_bag(const std::filesystem::path& path, const std::vector<TestMessage>& messages,
                    const BagLayout& layout = {});
void write_mcap(const std::filesystem::path& path, const std::vector<TestMessage>& messages,
                const BagLayout& layout = {}, MessageFormat format = MessageFormat::kCdr);
void write_sqlite_bag(const std::filesystem::path& path, const std::vector<TestMessage>& messages);

Bytes pack(Packing packing, std::span<const std::uint8_t> bytes);

/// Leaves the first `size` bytes of a file.
void cut_off(const std::filesystem::path& path, std::uint64_t size);

}  // namespace ldso
