// MCAP (mcap.dev/spec): records of an opcode, a length and the content; schemas name the types of messages, channels
// the topics.

#include <algorithm>
#include <map>
#include <utility>

#include "io/bags/bag.h"
#include "io/bags/chunk_scanner.h"
#include "ldso/error.h"

namespace ldso {
namespace {

enum McapRecord : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kMcapChunk = 0x06,
  kMessageIndex = 0x07
};

constexpr std::uint64_t kRecordHead = 9;    ///< Opcode and length.
constexpr std::uint64_t kMessageHead = 22;  ///< Channel, number, two times.
constexpr std::uint64_t kMostChunkHead = 128;
/// Schemas, channels and indices of a chunk.
constexpr std::uint64_t kMostDescription = 1 << 26;

MessageExtent find_mcap_message(std::span<const std::uint8_t> head, const std::string& where) {
  WireReader reader(head, where);
  reader.bytes(1);
  const auto size = reader.number<std::uint64_t>();
  if (size < kMessageHead) throw Error(where, "a message is damaged", "copy the bag again");
  return {kRecordHead + kMessageHead, static_cast<std::size_t>(size - kMessageHead)};
}

MessageFormat format_of(const std::string& encoding) {
  return encoding == "cdr" ? MessageFormat::kCdr : encoding == "ros1" ? MessageFormat::kRos1 : MessageFormat::kOther;
}

class McapScanner final : public ChunkScanner {
 public:
  using ChunkScanner::ChunkScanner;

 private:
  bool is_at_end(std::uint64_t) const override { return has_footer_; }

  std::uint64_t read_record(std::uint64_t offset) override {
    const std::vector<std::uint8_t> head = file_.read(offset, kRecordHead);
    WireReader reader(head, where_);
    const auto op = reader.number<std::uint8_t>();
    const auto size = reader.number<std::uint64_t>();
    const std::uint64_t content = offset + kRecordHead;
    if (op == kMcapChunk) add_chunk(content);
    if (size > file_.size() - content) throw Error(where_, "a record is cut off", "");
    if (op == kMessage) add_message_as_chunk(offset, kRecordHead + size);
    if ((op == kSchema || op == kChannel || op == kMessageIndex) && size <= kMostDescription)
      add_description(op, file_.read(content, size));
    has_footer_ = op == kFooter;
    return content + size;
  }

  void read_record_of_chunk(WireReader& records, std::uint32_t chunk, bool with_messages) override {
    const std::uint64_t begin = records.position();
    const auto op = records.number<std::uint8_t>();
    const std::span<const std::uint8_t> content = records.bytes(records.number<std::uint64_t>());
    if (op == kSchema || op == kChannel) add_description(op, content);
    if (op == kMessage && with_messages) add_message(content, chunk, begin);
  }

  void add_chunk(std::uint64_t content) {
    const std::vector<std::uint8_t> head = file_.read(content, kMostChunkHead);
    WireReader reader(head, where_);
    reader.bytes(16);
    const auto unpacked = reader.number<std::uint64_t>();
    reader.bytes(4);
    const std::string packing = reader.text();
    const auto size = reader.number<std::uint64_t>();
    const std::uint64_t records = content + reader.position();
    begin_chunk({records, std::min(size, file_.size() - records), unpacked}, packing);
  }

  /// A message outside of chunks counts as one of its own.
  void add_message_as_chunk(std::uint64_t offset, std::uint64_t size) {
    begin_chunk({offset, size, size}, "none");
    begin_index();
    add_message(file_.read(offset + kRecordHead, kMessageHead), last_chunk(), 0);
  }

  void add_message(std::span<const std::uint8_t> content, std::uint32_t chunk, std::uint64_t offset) {
    WireReader reader(content, where_);
    const auto channel = reader.number<std::uint16_t>();
    reader.bytes(4);
    index_.add(channel, {reader.number<std::int64_t>(), 0, chunk, offset});
  }

  /// What says something of messages.
  void add_description(std::uint8_t op, std::span<const std::uint8_t> content) {
    WireReader reader(content, where_);
    const auto id = reader.number<std::uint16_t>();
    if (op == kSchema) {
      schemas_[id] = reader.text();
    } else if (op == kChannel) {
      const auto schema = reader.number<std::uint16_t>();
      const std::string topic = reader.text();
      index_.connections[id] = {topic, plain_type(schemas_[schema]), format_of(reader.text())};
    } else if (!index_.chunks.empty()) {
      add_index(id, reader.sequence());
    }
  }

  void add_index(std::uint16_t channel, std::span<const std::uint8_t> entries) {
    begin_index();
    for (WireReader entry(entries, where_); entry.remaining() > 0;) {
      const auto time = entry.number<std::int64_t>();
      index_.add(channel, {time, 0, last_chunk(), entry.number<std::uint64_t>()});
    }
  }

  std::map<std::uint16_t, std::string> schemas_;
  bool has_footer_ = false;
};

}  // namespace

std::unique_ptr<Bag> open_mcap_bag(const std::filesystem::path& path) {
  auto file = std::make_unique<BagFile>(path);
  BagIndex index = McapScanner(*file).scan(kMcapMagic.size());
  return make_chunked_bag(std::move(file), std::move(index), &find_mcap_message);
}

}  // namespace ldso
