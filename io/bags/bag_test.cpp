#include "io/bags/bag.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "io/bags/test_bags.h"
#include "io/datasets/test_sequences.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImage = "sensor_msgs/msg/Image";

/// Message `i` of ten: every third on /b, of 100 bytes each.
Bytes content_of(int i) { return Bytes(100, static_cast<std::uint8_t>(i)); }

std::vector<TestMessage> ten_messages() {
  std::vector<TestMessage> messages;
  for (int i = 0; i < 10; ++i)
    messages.push_back({i % 3 == 2 ? "/b" : "/a", kImage, 1'700'000'000'000'000'000 + i * 1000, content_of(i)});
  return messages;
}

std::size_t topic_of(const Bag& bag, const std::string& name) {
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].name == name) return i;
  }
  ADD_FAILURE() << "there is no topic " << name;
  return 0;
}

/// First bytes of the messages of a topic.
std::vector<int> read_all(const Bag& bag, const std::string& topic) {
  std::vector<int> read;
  for (const BagMessage& message : bag.messages(topic_of(bag, topic))) {
    const Bytes bytes = bag.read(message);
    EXPECT_EQ(bytes.size(), 100U);
    EXPECT_EQ(message.time_ns, 1'700'000'000'000'000'000 + bytes.at(0) * 1000);
    EXPECT_EQ(bag.read(message, 7).size(), 7U);
    read.push_back(bytes.at(0));
  }
  return read;
}

struct Case {
  std::string name;
  std::function<void(const fs::path&)> write;
};

std::vector<Case> all_kinds() {
  const auto ros1 = [](Packing packing) {
    return [=](const fs::path& path) { write_ros1_bag(path, ten_messages(), {packing}); };
  };
  const auto mcap = [](Packing packing) {
    return [=](const fs::path& path) { write_mcap(path, ten_messages(), {packing}); };
  };
  return {{"none.bag", ros1(Packing::kNone)},
          {"bz2.bag", ros1(Packing::kBz2)},
          {"lz4.bag", ros1(Packing::kLz4)},
          {"none.mcap", mcap(Packing::kNone)},
          {"lz4.mcap", mcap(Packing::kLz4)},
          {"zstd.mcap", mcap(Packing::kZstd)},
          {"loose.mcap", [](const fs::path& path) { write_mcap(path, ten_messages(), {.has_chunks = false}); }},
          {"a.db3", [](const fs::path& path) { write_sqlite_bag(path, ten_messages()); }}};
}

TEST(Bag, HasAllMessagesOfEveryTopicInOrder) {
  const TemporaryFolder folder;
  for (const Case& kind : all_kinds()) {
    SCOPED_TRACE(kind.name);
    kind.write(folder / kind.name);
    EXPECT_TRUE(is_bag(folder / kind.name));
    const auto bag = open_bag(folder / kind.name);
    ASSERT_EQ(bag->topics().size(), 2U);
    EXPECT_EQ(bag->topics()[topic_of(*bag, "/a")].type, "sensor_msgs/Image");
    EXPECT_EQ(bag->topics()[topic_of(*bag, "/a")].count, 7U);
    EXPECT_EQ(read_all(*bag, "/a"), (std::vector{0, 1, 3, 4, 6, 7, 9}));
    EXPECT_EQ(read_all(*bag, "/b"), (std::vector{2, 5, 8}));
    EXPECT_TRUE(bag->warnings().empty()) << bag->warnings().front();
  }
}

TEST(Bag, WithoutIndexIsReadAndSaid) {
  const TemporaryFolder folder;
  for (const Packing packing : {Packing::kNone, Packing::kLz4}) {
    BagLayout layout{packing};
    layout.has_index = false;
    write_ros1_bag(folder / "a.bag", ten_messages(), layout);
    write_mcap(folder / "a.mcap", ten_messages(), layout);
    for (const char* name : {"a.bag", "a.mcap"}) {
      SCOPED_TRACE(name);
      const auto bag = open_bag(folder / name);
      EXPECT_EQ(read_all(*bag, "/a"), (std::vector{0, 1, 3, 4, 6, 7, 9}));
      EXPECT_EQ(bag->warnings().size(), 1U) << bag->warnings().back();
    }
  }
}

TEST(Bag, CutOffAnywhereIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  for (const Case& kind : all_kinds()) {
    SCOPED_TRACE(kind.name);
    const fs::path path = folder / kind.name;
    kind.write(path);
    const std::string whole = read_file(path);
    std::size_t before = 0, most = 0;
    for (std::size_t size = 16; size < whole.size(); size += 211) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, size);
      std::size_t count = 0;
      try {
        const auto bag = open_bag(path);
        for (const BagTopic& topic : bag->topics()) count += topic.count;
        EXPECT_FALSE(bag->warnings().empty()) << size;
      } catch (const Error&) {
      }
      EXPECT_GE(count, before) << size;
      before = count;
      most = std::max(most, count);
    }
    EXPECT_GE(most, kind.name == "a.db3" ? 0U : 9U);
    fs::remove(path);
  }
}

/// Messages that do not fit into one page of the table, as images are.
TEST(Bag, OfSqliteThatIsCutOffHasItsFirstMessages) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages;
  for (int i = 0; i < 40; ++i) messages.push_back({"/a", kImage, i, Bytes(20'000, static_cast<std::uint8_t>(i))});
  write_sqlite_bag(folder / "a.db3", messages);
  cut_off(folder / "a.db3", fs::file_size(folder / "a.db3") / 2);
  const auto bag = open_bag(folder / "a.db3");
  ASSERT_EQ(bag->warnings().size(), 1U);
  EXPECT_NE(bag->warnings()[0].find("cut off"), std::string::npos) << bag->warnings()[0];
  const std::vector<BagMessage> found = bag->messages(0);
  ASSERT_GE(found.size(), 10U);
  EXPECT_EQ(bag->read(found[5]), messages[5].bytes);
  EXPECT_FALSE(fs::exists(folder / "a.db3-journal") || fs::exists(folder / "a.db3-wal"));
}

TEST(Bag, MessagesPackedOneByOneAreUnpacked) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = ten_messages();
  for (TestMessage& message : messages) message.bytes = pack(Packing::kZstd, message.bytes);
  write_sqlite_bag(folder / "a.db3", messages);
  EXPECT_EQ(read_all(*open_bag(folder / "a.db3"), "/b"), (std::vector{2, 5, 8}));
}

TEST(Bag, DamagedChunkCostsItsMessagesAlone) {
  const TemporaryFolder folder;
  write_mcap(folder / "a.mcap", ten_messages(), {Packing::kZstd});
  Bytes bytes(fs::file_size(folder / "a.mcap"));
  {
    std::fstream file(folder / "a.mcap", std::ios::in | std::ios::out | std::ios::binary);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const Bytes magic{0x28, 0xb5, 0x2f, 0xfd};
    auto at = std::search(bytes.begin(), bytes.end(), magic.begin(), magic.end());
    at = std::search(at + 1, bytes.end(), magic.begin(), magic.end());  // Of the second chunk.
    file.seekp(at - bytes.begin());
    file.write("xxxx", 4);
  }
  const auto bag = open_bag(folder / "a.mcap");
  const std::vector<BagMessage> messages = bag->messages(topic_of(*bag, "/a"));
  ASSERT_EQ(messages.size(), 7U);
  EXPECT_EQ(bag->read(messages[0]), content_of(0));
  EXPECT_NE(error_of([&] { bag->read(messages[2]); }).find("a.mcap"), std::string::npos);
  EXPECT_EQ(bag->read(messages[4]), content_of(6));
}

TEST(Bag, OfSeveralFilesIsOne) {
  const TemporaryFolder folder;
  const std::vector<TestMessage> all = ten_messages();
  write_mcap(folder / "bag/bag_0.mcap", {all.begin(), all.begin() + 5});
  write_mcap(folder / "bag/bag_1.mcap", {all.begin() + 5, all.end()});
  write_text(folder / "bag/metadata.yaml",
             "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - bag/bag_0.mcap\n"
             "    - bag_1.mcap\n    - bag_2.mcap\n");
  EXPECT_TRUE(is_bag(folder / "bag"));
  EXPECT_FALSE(is_bag(folder.path()));
  const auto bag = open_bag(folder / "bag");
  EXPECT_EQ(read_all(*bag, "/a"), (std::vector{0, 1, 3, 4, 6, 7, 9}));
  ASSERT_EQ(bag->warnings().size(), 1U);
  EXPECT_NE(bag->warnings()[0].find("bag_2.mcap"), std::string::npos);
}

TEST(Bag, WhatIsNoneIsRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const char* name, const std::string& content) {
    write_text(folder / name, content);
    EXPECT_TRUE(is_bag(folder / name));
    return error_of([&] { open_bag(folder / name); });
  };
  EXPECT_NE(refusal("empty.bag", "").find("empty"), std::string::npos);
  EXPECT_NE(refusal("text.mcap", "hello\n").find("is no bag"), std::string::npos);
  EXPECT_NE(refusal("old.bag", "#ROSBAG V1.2\n").find("old format"), std::string::npos);
  const std::string zstd_magic{0x28, static_cast<char>(0xb5), 0x2f, static_cast<char>(0xfd)};
  EXPECT_NE(refusal("a.db3.zstd", zstd_magic).find("zstd -d"), std::string::npos);
  std::string magic_alone(kRos1BagMagic);
  magic_alone.append(3, 'x');
  EXPECT_NE(refusal("only_magic", magic_alone).find("no message"), std::string::npos);
  std::string no_sqlite(kSqliteMagic);
  no_sqlite.append(200, 'x');
  EXPECT_NE(refusal("other.db3", no_sqlite).find("SQLite"), std::string::npos);
}

}  // namespace
}  // namespace ldso
