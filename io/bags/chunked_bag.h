#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/bags/bag.h"
#include "io/bags/unpack.h"

namespace ldso {

// What bags of ROS 1 and MCAP files have in common: records one after the other, the messages packed in chunks, behind
// each chunk where which message lies in it. So a bag is found out about record by record without unpacking it, however
// far it was written.

/// Reads anywhere in a file.
class BagFile {
 public:
  /// Throws Error if it cannot be read.
  explicit BagFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// As many bytes as there are, up to `count`.
  std::vector<std::uint8_t> read(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  mutable std::ifstream stream_;
  std::uint64_t size_ = 0;
};

struct BagChunk {
  std::uint64_t offset = 0;    ///< Of its bytes in the file.
  std::uint64_t size = 0;      ///< Of them.
  std::uint64_t unpacked = 0;  ///< Size that is announced.
  Packing packing = Packing::kNone;
};

/// Records of a chunk, as far as they can be had. Throws Error if it announces more than 512 MB.
Unpacked read_chunk(const BagFile& file, const BagChunk& chunk);

/// Where messages come from: a publisher on a topic.
struct BagConnection {
  std::string topic, type;
  MessageFormat format = MessageFormat::kOther;
};

struct BagIndex {
  std::vector<BagChunk> chunks;
  std::map<std::uint32_t, BagConnection> connections;
  std::map<std::uint32_t, std::vector<BagMessage>> messages;  ///< By their connection.
  std::vector<std::string> warnings;

  void add(std::uint32_t connection, BagMessage message) { messages[connection].push_back(message); }
  /// Forgets the messages of the chunk that was added last, if there is one.
  void forget_last_chunk();
  /// The chunk in which the first message of an unknown connection lies; nothing if all are known.
  std::optional<std::uint32_t> chunk_of_unknown() const;
};

/// Bytes of the message in the record that begins with `head`, from its beginning on. Throws Error.
struct MessageExtent {
  std::size_t offset = 0, size = 0;
};
using FindMessage = MessageExtent (*)(std::span<const std::uint8_t> head, const std::string& where);

/// That suffice for FindMessage.
inline constexpr std::size_t kRecordHeadBytes = 512;

/// Throws Error if there is no connection.
std::unique_ptr<Bag> make_chunked_bag(std::unique_ptr<BagFile> file, BagIndex index, FindMessage find);

/// Sorts by time of recording, in case a writer did not.
void sort_by_time(std::vector<BagMessage>& messages);

}  // namespace ldso
