#include "io/bags/test_bags.h"

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <map>
#include <utility>

#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

WireWriter begin_message(std::int64_t stamp_ns, const std::string& frame, MessageFormat format, bool is_big_endian) {
  WireWriter writer(format, is_big_endian);
  if (format == MessageFormat::kRos1) writer.number<std::uint32_t>(7);
  writer.number(static_cast<std::uint32_t>(stamp_ns / kSecond)).number(static_cast<std::uint32_t>(stamp_ns % kSecond));
  writer.text(frame);
  return writer;
}

using Field = std::pair<std::string, Bytes>;

template <class T>
Field number_field(const std::string& name, T value) {
  return {name, WireWriter().number(value).bytes()};
}

Field text_field(const std::string& name, const std::string& text) { return {name, {text.begin(), text.end()}}; }

Bytes header_of(const std::vector<Field>& fields) {
  WireWriter header;
  for (const auto& [name, value] : fields) {
    header.number(static_cast<std::uint32_t>(name.size() + 1 + value.size())).raw(name + "=").raw(value);
  }
  return header.bytes();
}

Bytes ros1_record(const std::vector<Field>& fields, std::span<const std::uint8_t> data) {
  return WireWriter().sequence(header_of(fields)).sequence(data).bytes();
}

std::uint64_t ros1_time(std::int64_t ns) {
  return static_cast<std::uint64_t>(ns / kSecond) | static_cast<std::uint64_t>(ns % kSecond) << 32U;
}

Bytes mcap_record(std::uint8_t op, const Bytes& content) {
  return WireWriter().number(op).number(static_cast<std::uint64_t>(content.size())).raw(content).bytes();
}

/// Numbers of topics, in the order in which they come.
class TopicNumbers {
 public:
  /// The topic's, and whether it is new.
  std::pair<std::uint16_t, bool> operator()(const std::string& topic) {
    const auto [entry, is_new] = numbers_.emplace(topic, static_cast<std::uint16_t>(numbers_.size() + 1));
    return {entry->second, is_new};
  }

 private:
  std::map<std::string, std::uint16_t> numbers_;
};

/// What stands behind a chunk: where which messages lie in it.
using ChunkIndex = std::map<std::uint16_t, std::vector<std::pair<std::int64_t, std::uint64_t>>>;

Bytes ros1_chunk(const Bytes& records, const ChunkIndex& index, const BagLayout& layout) {
  const char* const names[] = {"none", "bz2", "lz4", "zstd"};
  WireWriter out;
  out.raw(ros1_record(
      {number_field<std::uint8_t>("op", 5), text_field("compression", names[static_cast<int>(layout.packing)]),
       number_field("size", static_cast<std::uint32_t>(records.size()))},
      pack(layout.packing, records)));
  for (const auto& [number, entries] : index) {
    WireWriter data;
    for (const auto& [time, offset] : entries) data.number(ros1_time(time)).number(static_cast<std::uint32_t>(offset));
    if (!layout.has_index) continue;
    out.raw(ros1_record({number_field<std::uint8_t>("op", 4), number_field<std::uint32_t>("ver", 1),
                         number_field<std::uint32_t>("conn", number),
                         number_field("count", static_cast<std::uint32_t>(entries.size()))},
                        data.bytes()));
  }
  return out.bytes();
}

Bytes ros1_connection(std::uint16_t number, const TestMessage& message) {
  const Bytes definition = header_of({text_field("topic", message.topic), text_field("type", message.type),
                                      text_field("md5sum", "*"), text_field("message_definition", "...")});
  return ros1_record({number_field<std::uint8_t>("op", 7), number_field<std::uint32_t>("conn", number),
                      text_field("topic", message.topic)},
                     definition);
}

Bytes mcap_chunk(const Bytes& records, const ChunkIndex& index, const BagLayout& layout) {
  const char* const names[] = {"", "bz2", "lz4", "zstd"};
  WireWriter chunk;
  chunk.number<std::uint64_t>(0).number<std::uint64_t>(0).number<std::uint64_t>(records.size());
  chunk.number<std::uint32_t>(0).text(names[static_cast<int>(layout.packing)]);
  const Bytes packed = pack(layout.packing, records);
  chunk.number<std::uint64_t>(packed.size()).raw(packed);
  WireWriter out;
  out.raw(mcap_record(6, chunk.bytes()));
  for (const auto& [number, entries] : index) {
    WireWriter data;
    for (const auto& [time, offset] : entries) data.number(time).number(offset);
    if (layout.has_index) out.raw(mcap_record(7, WireWriter().number(number).sequence(data.bytes()).bytes()));
  }
  return out.bytes();
}

Bytes mcap_channel(std::uint16_t number, const TestMessage& message, MessageFormat format) {
  const bool is_ros1 = format == MessageFormat::kRos1;
  const Bytes schema =
      WireWriter().number(number).text(message.type).text(is_ros1 ? "ros1msg" : "ros2msg").text("...").bytes();
  const Bytes channel =
      WireWriter().number(number).number(number).text(message.topic).text(is_ros1 ? "ros1" : "cdr").text("").bytes();
  return WireWriter().raw(mcap_record(3, schema)).raw(mcap_record(4, channel)).bytes();
}

void run(sqlite3* database, const std::string& command) {
  ASSERT_EQ(sqlite3_exec(database, command.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << command;
}

void insert_message(sqlite3* database, std::uint16_t topic, const TestMessage& message) {
  sqlite3_stmt* row = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &row,
                               nullptr),
            SQLITE_OK);
  sqlite3_bind_int(row, 1, topic);
  sqlite3_bind_int64(row, 2, message.time_ns);
  sqlite3_bind_blob(row, 3, message.bytes.data(), static_cast<int>(message.bytes.size()), SQLITE_STATIC);
  ASSERT_EQ(sqlite3_step(row), SQLITE_DONE);
  sqlite3_finalize(row);
}

}  // namespace

WireWriter::WireWriter(MessageFormat format, bool is_big_endian) : format_(format), is_big_endian_(is_big_endian) {
  if (format == MessageFormat::kCdr) bytes_ = {0, static_cast<std::uint8_t>(is_big_endian ? 0 : 1), 0, 0};
}

WireWriter& WireWriter::text(std::string_view text) {
  const bool is_cdr = format_ == MessageFormat::kCdr;
  number(static_cast<std::uint32_t>(text.size() + (is_cdr ? 1 : 0))).raw(text);
  if (is_cdr) bytes_.push_back(0);
  return *this;
}

WireWriter& WireWriter::sequence(std::span<const std::uint8_t> bytes) {
  return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes);
}

WireWriter& WireWriter::raw(std::span<const std::uint8_t> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return *this;
}

WireWriter& WireWriter::raw(std::string_view bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return *this;
}

void WireWriter::align(std::size_t size) {
  while (format_ == MessageFormat::kCdr && (bytes_.size() - 4) % size != 0) bytes_.push_back(0);
}

Bytes image_message(const TestImage& image, MessageFormat format, bool is_big_endian) {
  WireWriter writer = begin_message(image.stamp_ns, image.frame, format, is_big_endian);
  writer.number(static_cast<std::uint32_t>(image.height)).number(static_cast<std::uint32_t>(image.width));
  writer.text(image.encoding).number(static_cast<std::uint8_t>(image.is_big_endian));
  writer.number(static_cast<std::uint32_t>(image.step)).sequence(image.data);
  return writer.bytes();
}

Bytes compressed_message(std::int64_t stamp_ns, const std::string& kind, std::span<const std::uint8_t> file,
                         MessageFormat format) {
  return begin_message(stamp_ns, "camera", format, false).text(kind).sequence(file).bytes();
}

Bytes info_message(const TestInfo& info, MessageFormat format) {
  WireWriter writer = begin_message(kSecond, info.frame, format, false);
  writer.number(static_cast<std::uint32_t>(info.height)).number(static_cast<std::uint32_t>(info.width));
  writer.text(info.model).number(static_cast<std::uint32_t>(info.distortion.size()));
  for (const double k : info.distortion) writer.number(k);
  for (const double k : {info.fx, 0.0, info.cx, 0.0, info.fy, info.cy, 0.0, 0.0, 1.0}) writer.number(k);
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) writer.number(r);
  for (const double p : {info.rectified_fx, 0.0, info.cx, 0.0, 0.0, info.fy, info.cy, 0.0, 0.0, 0.0, 1.0, 0.0})
    writer.number(p);
  writer.number(info.binning).number(info.binning).number(info.roi_x).number(info.roi_y);
  writer.number(info.roi_height).number(info.roi_width).number<std::uint8_t>(0);
  return writer.bytes();
}

void write_ros1_bag(const std::filesystem::path& path, const std::vector<TestMessage>& messages,
                    const BagLayout& layout) {
  WireWriter chunks, records, connections;
  ChunkIndex index;
  TopicNumbers numbers;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto [number, is_new] = numbers(messages[i].topic);
    if (is_new) {
      records.raw(ros1_connection(number, messages[i]));
      connections.raw(ros1_connection(number, messages[i]));
    }
    index[number].emplace_back(messages[i].time_ns, records.bytes().size());
    records.raw(ros1_record({number_field<std::uint8_t>("op", 2), number_field<std::uint32_t>("conn", number),
                             number_field("time", ros1_time(messages[i].time_ns))},
                            messages[i].bytes));
    if ((i + 1) % static_cast<std::size_t>(layout.messages_per_chunk) != 0 && i + 1 < messages.size()) continue;
    chunks.raw(ros1_chunk(records.bytes(), index, layout));
    records = WireWriter();
    index.clear();
  }
  WireWriter bag;
  bag.raw(kRos1BagMagic);
  const auto head = [&](std::uint64_t index_position) {
    return ros1_record({number_field<std::uint8_t>("op", 3), number_field("index_pos", index_position),
                        number_field<std::uint32_t>("conn_count", 1), number_field<std::uint32_t>("chunk_count", 1)},
                       Bytes(64, ' '));
  };
  const std::uint64_t end = kRos1BagMagic.size() + head(0).size() + chunks.bytes().size();
  bag.raw(head(layout.has_index ? end : 0));
  bag.raw(chunks.bytes());
  if (layout.has_index) bag.raw(connections.bytes());
  write_bytes(path, bag.bytes());
}

void write_mcap(const std::filesystem::path& path, const std::vector<TestMessage>& messages, const BagLayout& layout,
                MessageFormat format) {
  WireWriter file, records, channels;
  ChunkIndex index;
  TopicNumbers numbers;
  file.raw(kMcapMagic).raw(mcap_record(1, WireWriter().text("ros2").text("a test").bytes()));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto [number, is_new] = numbers(messages[i].topic);
    WireWriter& out = layout.has_chunks ? records : file;
    if (is_new) {
      out.raw(mcap_channel(number, messages[i], format));
      channels.raw(mcap_channel(number, messages[i], format));
    }
    index[number].emplace_back(messages[i].time_ns, records.bytes().size());
    out.raw(mcap_record(5, WireWriter()
                               .number(number)
                               .number<std::uint32_t>(static_cast<std::uint32_t>(i))
                               .number(messages[i].time_ns)
                               .number(messages[i].time_ns)
                               .raw(messages[i].bytes)
                               .bytes()));
    const bool is_full = (i + 1) % static_cast<std::size_t>(layout.messages_per_chunk) == 0 || i + 1 == messages.size();
    if (!layout.has_chunks || !is_full) continue;
    file.raw(mcap_chunk(records.bytes(), index, layout));
    records = WireWriter();
    index.clear();
  }
  if (layout.has_index) {
    file.raw(mcap_record(0x0f, Bytes(4))).raw(channels.bytes()).raw(mcap_record(2, Bytes(20))).raw(kMcapMagic);
  }
  write_bytes(path, file.bytes());
}

void write_sqlite_bag(const std::filesystem::path& path, const std::vector<TestMessage>& messages) {
  std::filesystem::create_directories(path.parent_path());
  std::filesystem::remove(path);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  run(database, "PRAGMA page_size=4096");
  run(database,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT "
      "NOT NULL, offered_qos_profiles TEXT NOT NULL)");
  run(database,
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB "
      "NOT NULL)");
  run(database, "CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  TopicNumbers numbers;
  run(database, "BEGIN");
  for (const TestMessage& message : messages) {
    const auto [number, is_new] = numbers(message.topic);
    if (is_new) {
      run(database, "INSERT INTO topics VALUES(" + std::to_string(number) + ", '" + message.topic + "', '" +
                        message.type + "', 'cdr', '')");
    }
    insert_message(database, number, message);
  }
  run(database, "COMMIT");
  sqlite3_close(database);
}

Bytes pack(Packing packing, std::span<const std::uint8_t> bytes) {
  Bytes packed(bytes.size() * 2 + 1024);
  std::size_t size = packed.size();
  if (packing == Packing::kNone) return {bytes.begin(), bytes.end()};
  if (packing == Packing::kLz4) {
    size = LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr);
  } else if (packing == Packing::kZstd) {
    size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1);
  } else {
    auto count = static_cast<unsigned>(packed.size());
    Bytes copy(bytes.begin(), bytes.end());
    copy.reserve(1);  // The library takes no null pointer.
    auto* const from = reinterpret_cast<char*>(copy.data());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(packed.data()), &count, from,
                                       static_cast<unsigned>(bytes.size()), 9, 0, 0),
              BZ_OK);
    size = count;
  }
  packed.resize(size);
  return packed;
}

void cut_off(const std::filesystem::path& path, std::uint64_t size) { std::filesystem::resize_file(path, size); }

}  // namespace ldso
