// SQLite bags of ROS 2 (rosbag2_storage_sqlite3): a table of topics and one of messages.

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "io/bags/bag.h"
#include "io/bags/chunked_bag.h"
#include "io/images/header_bytes.h"
#include "io/images/image_header.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// Zstandard's first bytes. A message in CDR begins with a zero, so that messages which rosbag2 packed one by one tell
/// themselves apart.
constexpr std::array<std::uint8_t, 4> kZstdMagic{0x28, 0xb5, 0x2f, 0xfd};

constexpr std::uint64_t kSqliteHeaderBytes = 100;

/// Nothing but reading: SQLite would write beside a file that a recorder left open.
std::string uri_of(const fs::path& path) {
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += c == '%' ? "%25" : c == '?' ? "%3f" : "%23";
    } else {
      uri += c;
    }
  }
  return uri + "?mode=ro&immutable=1";
}

std::string text_of(sqlite3_stmt* row, int column) {
  const unsigned char* text = sqlite3_column_text(row, column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

class SqliteBag final : public Bag {
 public:
  explicit SqliteBag(fs::path path) : path_(std::move(path)) {
    open();
    check_is_table("topics");
    check_is_table("messages");
    read_topics();
    read_messages();
    say_cut_off();
    say_unwritten();
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::vector<BagMessage> messages(std::size_t topic) const override { return messages_.at(topic); }

  std::vector<std::uint8_t> read(const BagMessage& message, std::size_t most) const override {
    const Blob blob = open_blob(message);
    std::vector<std::uint8_t> bytes = read_blob(blob, std::min(most, size_of(blob)));
    if (bytes.size() < kZstdMagic.size() || !std::equal(kZstdMagic.begin(), kZstdMagic.end(), bytes.begin()))
      return bytes;
    Unpacked unpacked = unpack(Packing::kZstd, read_blob(blob, size_of(blob)), kMostImageBytes);
    if (!unpacked.problem.empty()) throw Error(path_.string(), "a message is damaged: " + unpacked.problem, "");
    unpacked.bytes.resize(std::min(most, unpacked.bytes.size()));
    return std::move(unpacked.bytes);
  }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
  };
  using Blob = std::unique_ptr<sqlite3_blob, Close>;
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  void open() {
    sqlite3* raw = nullptr;
    const int code = sqlite3_open_v2(uri_of(path_).c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) fail();
    // A file that is cut off is refused otherwise, whatever could be read of it.
    sqlite3_db_config(raw, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostImageBytes));
  }

  /// Not a view, which could be any program.
  void check_is_table(const std::string& name) const {
    const Statement row = prepare("SELECT type FROM sqlite_master WHERE name = '" + name + "'");
    if (sqlite3_step(row.get()) == SQLITE_ROW && text_of(row.get(), 0) == "table") return;
    throw Error(path_.string(), "is an SQLite file without the table '" + name + "' of a ROS 2 bag",
                "give a bag as `ros2 bag record` writes it");
  }

  void read_topics() {
    const Statement row = prepare("SELECT id, name, type, serialization_format FROM topics");
    int code = SQLITE_ROW;
    for (; (code = sqlite3_step(row.get())) == SQLITE_ROW;) {
      numbers_[sqlite3_column_int64(row.get(), 0)] = topics_.size();
      const MessageFormat format = text_of(row.get(), 3) == "cdr" ? MessageFormat::kCdr : MessageFormat::kOther;
      topics_.push_back({text_of(row.get(), 1), plain_type(text_of(row.get(), 2)), format, 0});
    }
    if (code != SQLITE_DONE) fail();
    messages_.resize(topics_.size());
  }

  /// In the order of the rows, so that those in front of a damage are found.
  void read_messages() {
    const Statement row = prepare("SELECT rowid, topic_id, timestamp FROM messages");
    int code = SQLITE_ROW;
    std::size_t count = 0;
    for (; (code = sqlite3_step(row.get())) == SQLITE_ROW; ++count) {
      const auto topic = numbers_.find(sqlite3_column_int64(row.get(), 1));
      if (topic == numbers_.end()) continue;
      const auto place = static_cast<std::uint64_t>(sqlite3_column_int64(row.get(), 0));
      messages_[topic->second].push_back({sqlite3_column_int64(row.get(), 2), 0, 0, place});
    }
    if (code != SQLITE_DONE) {
      warnings_.push_back(path_.string() + ": the bag is cut off or damaged (" + sqlite3_errmsg(database_.get()) +
                          "); " + std::to_string(count) + " messages before that are used");
    }
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      sort_by_time(messages_[i]);
      topics_[i].count = messages_[i].size();
    }
  }

  /// What is missing may be nothing but an index, but that is not known.
  void say_cut_off() {
    const BagFile file(path_);
    const std::vector<std::uint8_t> bytes = file.read(0, kSqliteHeaderBytes);
    const HeaderBytes header(bytes);
    const std::int64_t page = header.big(16, 2) == 1 ? 65536 : header.big(16, 2);
    if (!warnings_.empty() || header.big(28, 4) * page <= static_cast<std::int64_t>(file.size())) return;
    warnings_.push_back(path_.string() + ": the bag is cut off; the messages that are left are used");
  }

  void say_unwritten() {
    std::error_code error;
    const fs::path log = path_.string() + "-wal";
    if (const auto size = fs::file_size(log, error); error || size == 0) return;
    warnings_.push_back(log.string() +
                        ": the recording was not ended, and its last messages lie there; they are not "
                        "used (`sqlite3 " +
                        path_.filename().string() + " 'PRAGMA wal_checkpoint'` brings them in)");
  }

  Statement prepare(const std::string& query) const {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &raw, nullptr) != SQLITE_OK) fail();
    return Statement(raw);
  }

  Blob open_blob(const BagMessage& message) const {
    sqlite3_blob* raw = nullptr;
    const int code = sqlite3_blob_open(database_.get(), "main", "messages", "data",
                                       static_cast<sqlite3_int64>(message.offset), 0, &raw);
    Blob blob(raw);
    if (code != SQLITE_OK) fail();
    return blob;
  }

  static std::size_t size_of(const Blob& blob) { return static_cast<std::size_t>(sqlite3_blob_bytes(blob.get())); }

  std::vector<std::uint8_t> read_blob(const Blob& blob, std::size_t count) const {
    std::vector<std::uint8_t> bytes(count);
    if (sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(count), 0) != SQLITE_OK) fail();
    return bytes;
  }

  [[noreturn]] void fail() const {
    throw Error(path_.string(), std::string("the bag cannot be read (SQLite: ") + sqlite3_errmsg(database_.get()) + ")",
                "copy it again");
  }

  fs::path path_;
  std::unique_ptr<sqlite3, Close> database_;
  std::vector<BagTopic> topics_;
  std::map<std::int64_t, std::size_t> numbers_;  ///< Of topics_, by their ids.
  std::vector<std::vector<BagMessage>> messages_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<Bag> open_sqlite_bag(const std::filesystem::path& path) { return std::make_unique<SqliteBag>(path); }

}  // namespace ldso
