#include "io/bags/chunked_bag.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "io/images/image_header.h"
#include "ldso/error.h"

namespace ldso {
namespace {

class ChunkedBag final : public Bag {
 public:
  ChunkedBag(std::unique_ptr<BagFile> file, BagIndex index, FindMessage find)
      : file_(std::move(file)), index_(std::move(index)), find_(find) {
    for (const auto& [id, connection] : index_.connections) add_connection(id, connection);
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  const std::vector<std::string>& warnings() const override { return index_.warnings; }

  std::vector<BagMessage> messages(std::size_t topic) const override {
    std::vector<BagMessage> all;
    for (const std::uint32_t connection : connections_.at(topic)) {
      const auto found = index_.messages.find(connection);
      if (found != index_.messages.end()) all.insert(all.end(), found->second.begin(), found->second.end());
    }
    sort_by_time(all);
    return all;
  }

  std::vector<std::uint8_t> read(const BagMessage& message, std::size_t most) const override {
    const std::string where = file_->path().string();
    const MessageExtent extent = find_(part(message.chunk, message.offset, kRecordHeadBytes), where);
    const std::size_t wanted = std::min(most, extent.size);
    if (wanted > kMostImageBytes) throw Error(where, "a message is larger than 512 MB", "leave it out");
    std::vector<std::uint8_t> bytes = part(message.chunk, message.offset + extent.offset, wanted);
    if (bytes.size() < wanted) throw Error(where, "the message is cut off", "copy the bag again");
    return bytes;
  }

 private:
  /// Connections of one topic and type are one topic: several programs may have published on it.
  void add_connection(std::uint32_t id, const BagConnection& connection) {
    const auto is_same = [&](const BagTopic& topic) {
      return topic.name == connection.topic && topic.type == connection.type && topic.format == connection.format;
    };
    const auto found = std::find_if(topics_.begin(), topics_.end(), is_same);
    const auto topic = static_cast<std::size_t>(found - topics_.begin());
    if (found == topics_.end()) {
      topics_.push_back({connection.topic, connection.type, connection.format, 0});
      connections_.emplace_back();
    }
    connections_[topic].push_back(id);
    const auto own = index_.messages.find(id);
    if (own != index_.messages.end()) topics_[topic].count += own->second.size();
  }

  /// As many bytes of an unpacked chunk as there are, up to `count`.
  std::vector<std::uint8_t> part(std::uint32_t number, std::uint64_t offset, std::size_t count) const {
    const BagChunk& chunk = index_.chunks.at(number);
    if (chunk.packing == Packing::kNone) {
      if (offset >= chunk.size) return {};
      return file_->read(chunk.offset + offset, std::min<std::uint64_t>(count, chunk.size - offset));
    }
    if (unpacked_number_ != number) {
      unpacked_ = read_chunk(*file_, chunk).bytes;
      unpacked_number_ = number;
    }
    if (offset >= unpacked_.size()) return {};
    const auto begin = unpacked_.begin() + static_cast<std::ptrdiff_t>(offset);
    return {begin, begin + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(count, unpacked_.size() - offset))};
  }

  std::unique_ptr<BagFile> file_;
  BagIndex index_;
  FindMessage find_;
  std::vector<BagTopic> topics_;
  std::vector<std::vector<std::uint32_t>> connections_;  ///< Of each topic.
  // The chunk that was read last; messages are mostly read in order.
  mutable std::optional<std::uint32_t> unpacked_number_;
  mutable std::vector<std::uint8_t> unpacked_;
};

}  // namespace

BagFile::BagFile(std::filesystem::path path) : path_(std::move(path)), stream_(path_, std::ios::binary) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  if (!stream_ || error) throw Error(path_.string(), "cannot be read", "check its permissions");
}

std::vector<std::uint8_t> BagFile::read(std::uint64_t offset, std::uint64_t count) const {
  if (offset >= size_) return {};
  std::vector<std::uint8_t> bytes(std::min(count, size_ - offset));
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream_.gcount(), 0)));
  return bytes;
}

Unpacked read_chunk(const BagFile& file, const BagChunk& chunk) {
  if (std::max(chunk.unpacked, chunk.size) > kMostImageBytes) {
    throw Error(file.path().string() + ", chunk at byte " + std::to_string(chunk.offset),
                "it announces more than 512 MB", "record with smaller chunks");
  }
  return unpack(chunk.packing, file.read(chunk.offset, chunk.size), chunk.unpacked);
}

void BagIndex::forget_last_chunk() {
  for (auto& [connection, own] : messages)
    std::erase_if(own, [&](const BagMessage& message) { return message.chunk + 1 == chunks.size(); });
}

std::optional<std::uint32_t> BagIndex::chunk_of_unknown() const {
  for (const auto& [connection, own] : messages) {
    if (!own.empty() && !connections.contains(connection)) return own.front().chunk;
  }
  return std::nullopt;
}

std::unique_ptr<Bag> make_chunked_bag(std::unique_ptr<BagFile> file, BagIndex index, FindMessage find) {
  if (index.connections.empty()) {
    std::string why = "there is no message in the bag that can be read";
    if (!index.warnings.empty()) why += " (" + index.warnings.front() + ")";
    throw Error(file->path().string(), why, "copy it again, or record it again");
  }
  return std::make_unique<ChunkedBag>(std::move(file), std::move(index), find);
}

void sort_by_time(std::vector<BagMessage>& messages) {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const BagMessage& a, const BagMessage& b) { return a.time_ns < b.time_ns; });
}

}  // namespace ldso
