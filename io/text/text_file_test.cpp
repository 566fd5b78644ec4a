#include "io/text/text_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

TEST(TextFile, KeepsLineNumbersOverCommentsAndBlankLines) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "# head\n\n1 2\r\n  \t\n # indented comment\n3\t4");
  const TextFile file(folder / "a.txt");
  ASSERT_EQ(file.lines().size(), 2U);
  EXPECT_EQ(file.lines()[0].number, 3);
  EXPECT_EQ(file.lines()[1].number, 6);
  EXPECT_EQ(file.number(file.lines()[0], 1), 2.0);
  EXPECT_EQ(file.number(file.lines()[1], 1), 4.0);
}

TEST(TextFile, NamesFileAndLineOfWhatIsNoNumber) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "1 2\n3 4x\nnan\n");
  const TextFile file(folder / "a.txt");
  const std::string message = error_of([&] { file.number(file.lines()[1], 1); });
  EXPECT_NE(message.find((folder / "a.txt").string() + ":2"), std::string::npos) << message;
  EXPECT_NE(message.find("'4x'"), std::string::npos) << message;
  EXPECT_NE(error_of([&] { file.number(file.lines()[1], 2); }).find("2 fields"), std::string::npos);
  EXPECT_TRUE(std::isnan(file.number(file.lines()[2], 0)));
  EXPECT_NE(error_of([&] { file.finite_number(file.lines()[2], 0); }).find("not finite"), std::string::npos);
}

TEST(TextFile, ByteOrderMarksAreNoPartOfTheFirstField) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt",
             "\xef\xbb\xbf"
             "1 2\n");
  EXPECT_EQ(TextFile(folder / "a.txt").number(TextFile(folder / "a.txt").lines()[0], 0), 1);
  write_text(folder / "b.txt", "\xef\xbb\xbf# a comment\n3\n");
  EXPECT_EQ(TextFile(folder / "b.txt").lines().size(), 1U);
  write_text(folder / "c.txt", std::string("\xff\xfe"
                                           "1\0\n\0",
                                           6));
  EXPECT_NE(error_of([&] { TextFile(folder / "c.txt"); }).find("UTF-16"), std::string::npos);
}

TEST(TextFile, CommentsMayFollowAFieldButNotBeginInOne) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "1 2 # two numbers\n0.1 rgb/a#1.png\n");
  const TextFile file(folder / "a.txt");
  EXPECT_EQ(file.lines()[0].fields.size(), 2U);
  EXPECT_EQ(file.lines()[1].fields[1], "rgb/a#1.png");
}

TEST(TextFile, SplitsAtCommasOnlyIfAsked) {
  const TemporaryFolder folder;
  write_text(folder / "a.csv", "1,2, 3\n");
  EXPECT_EQ(TextFile(folder / "a.csv", true).lines()[0].fields.size(), 3U);
  EXPECT_EQ(TextFile(folder / "a.csv").lines()[0].fields.size(), 2U);
}

TEST(TextFile, MissingFileAndFolderAreErrors) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { TextFile file(folder / "missing.txt"); }).find("missing.txt"), std::string::npos);
  EXPECT_NE(error_of([&] { TextFile file(folder.path()); }).find("is a folder"), std::string::npos);
}

TEST(ParseNumber, TakesWholeFieldsOnly) {
  double value = 0;
  EXPECT_TRUE(parse_number("-1.5e-3", value));
  EXPECT_DOUBLE_EQ(value, -1.5e-3);
  EXPECT_TRUE(parse_number("+2", value));
  EXPECT_DOUBLE_EQ(value, 2);
  for (const char* text : {"", "1,5", "1.5 ", "0x10", "one"}) EXPECT_FALSE(parse_number(text, value)) << text;
}

}  // namespace
}  // namespace ldso
