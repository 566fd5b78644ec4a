#include "io/text/yaml_node.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

YamlNode parsed(const std::string& text) { return YamlNode::parse(text, "a.yaml", "the file"); }

TEST(YamlNode, ReadsValuesOfEachKind) {
  const YamlNode node = parsed("n: 3\nx: 0.5\nlist: [1, 2.5]\non: yes\nword: b\nempty:\n");
  EXPECT_EQ(node.at("n").whole_number(0), 3);
  EXPECT_EQ(node.at("x").number(), 0.5);
  EXPECT_EQ(node.at("list").numbers(2), (std::vector<double>{1, 2.5}));
  EXPECT_TRUE(node.at("on").yes_or_no());
  EXPECT_EQ(node.at("word").one_of({"a", "b"}), 1u);
  EXPECT_TRUE(node.at("empty").is_null());
  EXPECT_TRUE(node.contains("n"));
  EXPECT_FALSE(node.contains("m"));
  EXPECT_FALSE(node.at("n").contains("m"));
  EXPECT_EQ(node.entries().size(), 6u);
}

TEST(YamlNode, ComplaintsNameFileAndLine) {
  const YamlNode node = parsed("a: 1\nb:\n  c: [1, x]\n");
  EXPECT_EQ(error_of([&] { node.at("d"); }), "a.yaml:1: 'the file' has no 'd'; add a line `d: value`");
  EXPECT_EQ(error_of([&] { node.at("b").at("c").numbers(2); }), "a.yaml:3: 'c' is 'x'; a finite number is expected");
  EXPECT_NE(error_of([&] { node.at("b").at("c").numbers(3); }), "");
  EXPECT_NE(error_of([&] { node.at("a").numbers(1); }).find("a.yaml:1: 'a' is no list of 1 numbers"),
            std::string::npos);
  EXPECT_NE(error_of([&] { node.at("b").scalar(); }).find("a.yaml:3: 'b' has no single value"), std::string::npos);
  EXPECT_NE(error_of([&] {
              node.at("a").check_key("depht", {"depth", "width"});
            }).find("did you mean 'depth'?"),
            std::string::npos);
  EXPECT_NE(error_of([] { parsed("a: 1\nb: [\n"); }).find("a.yaml:"), std::string::npos);
  EXPECT_NE(error_of([] { parsed("a: 1\na: 2\n").entries(); }).find("a.yaml:2: 'a' is set twice"), std::string::npos);
}

TEST(YamlNode, OpenCvsHeaderIsNoYaml) {
  const TemporaryFolder folder;
  write_text(folder / "a.yaml", "%YAML:1.0\nn: x\n");
  const YamlNode node = YamlNode::read(folder / "a.yaml", "the file");
  EXPECT_EQ(node.at("n").scalar(), "x");
  EXPECT_NE(error_of([&] { node.at("n").number(); }).find("a.yaml:2: "), std::string::npos);
}

TEST(YamlNode, AliasesMakeNoEndlessTrees) {
  EXPECT_NE(error_of([] { parsed("a: &a {b: *a}\n"); }).find("a.yaml:1: is nested more than 64 levels"),
            std::string::npos);
  EXPECT_NE(error_of([] { parsed("n: 1\na: &a [*a, *a]\n"); }).find("contains itself"), std::string::npos);
  std::string laughs = "l0: &l0 [x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = " *l" + std::to_string(i - 1);
    laughs += "l" + std::to_string(i) + ": &l" + std::to_string(i) + " [" + before + "," + before + "," + before + "," +
              before + "," + before + "," + before + "]\n";
  }
  EXPECT_NE(error_of([&] { parsed(laughs); }).find("more than 200000 values"), std::string::npos);
  EXPECT_EQ(parsed("a: &a 3\nb: *a\n").at("b").whole_number(0), 3);
}

TEST(YamlNode, IsTextInUtf8) {
  EXPECT_NE(error_of([] { parsed("loops: {vocabulary: b\xe4r}\n"); }).find("a.yaml: is no text in UTF-8"),
            std::string::npos);
  EXPECT_EQ(parsed("name: b\xc3\xa4r\n").at("name").text(), "b\xc3\xa4r");
}

TEST(YamlNode, WholeNumbersHaveLimits) {
  EXPECT_NE(error_of([] { parsed("n: 7\n").at("n").whole_number(1, 6); }).find("from 1 to 6"), std::string::npos);
  EXPECT_NE(error_of([] { parsed("n: 99999999999999999999\n").at("n").whole_number(1); }), "");
}

TEST(YamlNode, FilesMayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  write_text(folder / "a.yaml", "\xef\xbb\xbf%YAML:1.0\n---\na: 7\n");
  EXPECT_EQ(YamlNode::read(folder / "a.yaml", "file").at("a").number(), 7);
}

}  // namespace
}  // namespace ldso
