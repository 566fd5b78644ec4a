// The bag format 2.0 of ROS 1 (wiki.ros.org/Bags/Format/2.0): records of a header, which is fields `name=value`, and
// data.

#include <algorithm>
#include <map>
#include <utility>

#include "io/bags/bag.h"
#include "io/bags/chunk_scanner.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::uint64_t kNanoseconds = 1'000'000'000;

/// The field `op` of a record.
enum Ros1Record : std::uint8_t { kMessageData = 2, kBagHeader = 3, kIndexData = 4, kChunk = 5, kConnection = 7 };

/// Records have headers of a hundred bytes and connections messages' definitions of some thousand.
constexpr std::uint64_t kMostRos1Header = 1 << 20;
constexpr std::uint64_t kMostRos1Definition = 1 << 24;

/// Fields of a header.
class Ros1Fields {
 public:
  Ros1Fields(std::span<const std::uint8_t> bytes, const std::string& where) : where_(where) {
    for (WireReader reader(bytes, where); reader.remaining() > 0;) {
      const std::span<const std::uint8_t> field = reader.sequence();
      const auto equals = std::find(field.begin(), field.end(), '=');
      if (equals == field.end()) throw Error(where, "a field of a record has no value", "copy the bag again");
      fields_[std::string(field.begin(), equals)] = field.subspan(static_cast<std::size_t>(equals - field.begin()) + 1);
    }
  }

  template <class T>
  T number(const std::string& name) const {
    return WireReader(at(name), where_).number<T>();
  }
  std::string text(const std::string& name) const { return {at(name).begin(), at(name).end()}; }

 private:
  std::span<const std::uint8_t> at(const std::string& name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) throw Error(where_, "a record has no field '" + name + "'", "copy the bag again");
    return found->second;
  }

  std::string where_;
  std::map<std::string, std::span<const std::uint8_t>> fields_;
};

/// Seconds and nanoseconds.
std::int64_t time_of(std::uint64_t bits) {
  return static_cast<std::int64_t>((bits & 0xffffffff) * kNanoseconds + (bits >> 32U));
}

MessageExtent find_ros1_message(std::span<const std::uint8_t> head, const std::string& where) {
  WireReader reader(head, where);
  reader.sequence();
  const std::size_t size = reader.number<std::uint32_t>();
  return {reader.position(), size};
}

class Ros1Scanner final : public ChunkScanner {
 public:
  using ChunkScanner::ChunkScanner;

 private:
  bool is_at_end(std::uint64_t offset) const override { return offset >= file_.size(); }

  std::uint64_t read_record(std::uint64_t offset) override {
    const std::uint64_t header_size = number_at(offset);
    if (header_size > kMostRos1Header) throw Error(where_, "a record is damaged", "");
    const std::vector<std::uint8_t> header = file_.read(offset + 4, header_size);
    const std::uint64_t data = offset + 8 + header_size;
    const std::uint64_t data_size = number_at(data - 4);
    const Ros1Fields fields(header, where_);
    const auto op = fields.number<std::uint8_t>("op");
    if (op == kChunk) add_chunk(fields, data, std::min(data_size, file_.size() - data));
    if (data_size > file_.size() - data) throw Error(where_, "a record is cut off", "");
    if (op == kBagHeader) add_bag_header(fields);
    if (op == kIndexData) add_index(fields, file_.read(data, data_size));
    if (op == kConnection && data_size <= kMostRos1Definition) add_connection(fields, file_.read(data, data_size));
    return data + data_size;
  }

  void read_record_of_chunk(WireReader& records, std::uint32_t chunk, bool with_messages) override {
    const std::uint64_t begin = records.position();
    const Ros1Fields fields(records.sequence(), where_);
    const std::span<const std::uint8_t> data = records.sequence();
    const auto op = fields.number<std::uint8_t>("op");
    if (op == kConnection) add_connection(fields, data);
    if (op != kMessageData || !with_messages) return;
    index_.add(fields.number<std::uint32_t>("conn"), {time_of(fields.number<std::uint64_t>("time")), 0, chunk, begin});
  }

  std::uint64_t number_at(std::uint64_t offset) const {
    return WireReader(file_.read(offset, 4), where_).number<std::uint32_t>();
  }

  void add_bag_header(const Ros1Fields& fields) {
    const auto position = fields.number<std::uint64_t>("index_pos");
    if (position == 0) {
      index_.warnings.push_back(where_ + ": the bag was not closed and has no index; it is read without");
    } else if (position >= file_.size()) {
      index_.warnings.push_back(where_ + ": the bag is cut off: it has " + std::to_string(file_.size()) +
                                " bytes, and its index would be at byte " + std::to_string(position));
    }
  }

  void add_chunk(const Ros1Fields& fields, std::uint64_t offset, std::uint64_t size) {
    begin_chunk({offset, size, fields.number<std::uint32_t>("size")}, fields.text("compression"));
  }

  void add_index(const Ros1Fields& fields, const std::vector<std::uint8_t>& data) {
    if (index_.chunks.empty()) return;
    begin_index();
    const auto connection = fields.number<std::uint32_t>("conn");
    for (WireReader reader(data, where_); reader.remaining() > 0;) {
      const std::int64_t time = time_of(reader.number<std::uint64_t>());
      index_.add(connection, {time, 0, last_chunk(), reader.number<std::uint32_t>()});
    }
  }

  void add_connection(const Ros1Fields& fields, std::span<const std::uint8_t> data) {
    const Ros1Fields definition(data, where_);
    const auto id = fields.number<std::uint32_t>("conn");
    index_.connections[id] = {fields.text("topic"), plain_type(definition.text("type")), MessageFormat::kRos1};
  }
};

}  // namespace

std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path) {
  auto file = std::make_unique<BagFile>(path);
  BagIndex index = Ros1Scanner(*file).scan(kRos1BagMagic.size());
  return make_chunked_bag(std::move(file), std::move(index), &find_ros1_message);
}

}  // namespace ldso
