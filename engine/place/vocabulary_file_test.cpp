#include "place/vocabulary_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "ldso/error.h"
#include "place/test_descriptors.h"
#include "place/vocabulary_trainer.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

const Vocabulary& trained() {
  static const Vocabulary kVocabulary = [] {
    ThreadPool pool(1);
    TrainingOptions options;
    options.origin = "made up for a test";
    return train_vocabulary(place_test::made_up_images(20, 10), options, pool);
  }();
  return kVocabulary;
}

class VocabularyFile : public testing::Test {
 protected:
  VocabularyFile()
      : folder_(fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~VocabularyFile() override { fs::remove_all(folder_); }
  const fs::path folder_;
};

std::string message_of(const std::vector<std::uint8_t>& bytes) {
  try {
    parse_vocabulary(bytes, "some.file");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_message(const std::vector<std::uint8_t>& bytes, const std::string& part) {
  const std::string message = message_of(bytes);
  EXPECT_TRUE(message.starts_with("some.file")) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST_F(VocabularyFile, ComesBackAsItWas) {
  const fs::path path = folder_ / "a.ldsovoc";
  write_vocabulary(path, trained());
  const Vocabulary read = read_vocabulary(path);
  EXPECT_EQ(vocabulary_bytes(read), vocabulary_bytes(trained()));
  EXPECT_EQ(read.origin(), trained().origin());
  EXPECT_EQ(read.depth(), trained().depth());
  EXPECT_EQ(read.branching(), trained().branching());
  std::mt19937_64 random(9);
  for (int i = 0; i < 300; ++i) {
    const OrbDescriptor descriptor = place_test::random_descriptor(random);
    const WordId word = trained().word(descriptor);
    EXPECT_EQ(read.word(descriptor), word);
    EXPECT_EQ(read.weight(word), trained().weight(word));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "nothing else is left";
}

TEST_F(VocabularyFile, EveryDamageIsFound) {
  const std::vector<std::uint8_t> good = vocabulary_bytes(trained());
  ASSERT_EQ(message_of(good), "");
  for (std::size_t length = 0; length < good.size(); length += length < 100 ? 1 : 997)
    EXPECT_NE(message_of({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), "") << length;
  std::mt19937_64 random(1);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> damaged = good;
    damaged[i < 100 ? i % 40 : random() % good.size()] ^= static_cast<std::uint8_t>(1 << (random() % 8));
    EXPECT_NE(message_of(damaged), "") << i;
  }
}

TEST_F(VocabularyFile, MessagesSayWhatIsWrong) {
  std::vector<std::uint8_t> bytes = vocabulary_bytes(trained());
  expect_message({}, "empty");
  expect_message({'s', 'o', 'm', 'e', ' ', 't', 'e', 'x', 't'}, "ldso vocab train");
  expect_message({bytes.begin(), bytes.end() - 1}, "truncated");
  bytes.push_back(0);
  expect_message(bytes, "behind its end");
  bytes.pop_back();
  bytes[bytes.size() / 2] ^= 4;
  expect_message(bytes, "damaged");
  bytes[8] = 2;
  expect_message(bytes, "update ldso");
}

TEST_F(VocabularyFile, FilesThatCannotBeReadOrWritten) {
  EXPECT_THROW(read_vocabulary(folder_ / "missing"), Error);
  EXPECT_THROW(read_vocabulary(folder_), Error);
  EXPECT_THROW(write_vocabulary(folder_ / "no_folder" / "a.ldsovoc", trained()), Error);
  fs::create_directory(folder_ / "a_folder");
  EXPECT_THROW(write_vocabulary(folder_ / "a_folder", trained()), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "nothing else is left";
}

TEST_F(VocabularyFile, TooManyChildren) {
  std::vector<VocabularyNode> nodes(301);
  for (VocabularyNode& node : nodes) node.weight = 1;
  EXPECT_THROW(vocabulary_bytes(Vocabulary(nodes)), Error);
  nodes.resize(256);
  EXPECT_EQ(parse_vocabulary(vocabulary_bytes(Vocabulary(nodes)), "a").word_count(), 255u);
}

}  // namespace
}  // namespace ldso
