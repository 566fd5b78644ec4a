#include "place/dbow_vocabulary_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <random>
#include <sstream>
#include <vector>

#include "ldso/error.h"
#include "place/test_descriptors.h"
#include "place/vocabulary_file.h"

namespace ldso {
namespace {

struct DbowNode {
  std::uint32_t parent = 0;
  std::array<std::uint8_t, 32> bytes{};
  double weight = 0;
  bool is_leaf = true;
};

/// A tree of three levels with k = 4, as DBoW would number it: children get their numbers when their parent is divided,
/// and the first child is divided to the end before the second.
struct DbowTree {
  DbowTree() {
    nodes.push_back({});
    divide(0, 1);
  }
  void divide(std::uint32_t parent, int level) {
    nodes[parent].is_leaf = false;
    const auto first = static_cast<std::uint32_t>(nodes.size());
    for (int i = 0; i < 4; ++i) {
      DbowNode node;
      node.parent = parent;
      for (std::uint8_t& byte : node.bytes) byte = static_cast<std::uint8_t>(random());
      node.weight = 0.25 + static_cast<double>(random() % 128) / 16;
      nodes.push_back(node);
    }
    for (std::uint32_t i = 0; i < 4 && level < 3; ++i) {
      if (level == 1 || i != 2) divide(first + i, level + 1);  // Some words are higher up.
    }
  }
  std::mt19937 random{8};
  std::vector<DbowNode> nodes;
};

using Bytes = std::vector<std::uint8_t>;

Bytes text_file(const DbowTree& tree, const char* line_end = "\n") {
  std::ostringstream text;
  text << "4 3 0 0" << line_end;
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const DbowNode& node = tree.nodes[i];
    text << node.parent << " " << (node.is_leaf ? 1 : 0) << " ";
    for (const std::uint8_t byte : node.bytes) text << int{byte} << " ";
    text << node.weight << line_end;
  }
  const std::string content = text.str();
  return {content.begin(), content.end()};
}

template <class Number>
void put(Number value, Bytes& bytes) {
  static_assert(std::endian::native == std::endian::little, "this writer is for the usual machines");
  std::array<std::uint8_t, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &value, sizeof(value));
  for (const std::uint8_t byte : raw) bytes.push_back(byte);
}

/// Parents before children, the last sibling's children first; words in the order of the nodes.
Bytes binary_file(const DbowTree& tree) {
  Bytes bytes;
  put<std::uint64_t>(88877711233ULL, bytes);
  put<bool>(false, bytes);
  put(static_cast<std::uint32_t>(tree.nodes.size()), bytes);
  for (const int field : {4, 3, 0, 0}) put<std::int32_t>(field, bytes);
  std::vector<std::uint32_t> parents{0};
  while (!parents.empty()) {
    const std::uint32_t parent = parents.back();
    parents.pop_back();
    for (std::uint32_t i = 1; i < tree.nodes.size(); ++i) {
      if (tree.nodes[i].parent != parent) continue;
      put(i, bytes);
      put(parent, bytes);
      put(tree.nodes[i].weight, bytes);
      for (const int field : {32, 1, 0}) put<std::int32_t>(field, bytes);
      bytes.insert(bytes.end(), tree.nodes[i].bytes.begin(), tree.nodes[i].bytes.end());
      if (!tree.nodes[i].is_leaf) parents.push_back(i);
    }
  }
  Bytes words;
  std::uint32_t count = 0;
  for (std::uint32_t i = 1; i < tree.nodes.size(); ++i) {
    if (!tree.nodes[i].is_leaf) continue;
    put(count++, words);
    put(i, words);
  }
  put(count, bytes);
  bytes.insert(bytes.end(), words.begin(), words.end());
  return bytes;
}

/// The descent and the weights, by the definition of the tree itself.
double weight_by_descent(const DbowTree& tree, const OrbDescriptor& descriptor) {
  std::uint32_t node = 0;
  while (!tree.nodes[node].is_leaf) {
    int least = 257;
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < tree.nodes.size(); ++i) {
      if (tree.nodes[i].parent != node) continue;
      int distance = 0;
      for (int j = 0; j < 32; ++j) {
        const auto byte = static_cast<std::uint8_t>(descriptor.bits[j / 8] >> (8 * (j % 8)));
        distance += std::popcount(static_cast<std::uint8_t>(byte ^ tree.nodes[i].bytes[j]));
      }
      if (distance < least) best = i;
      least = std::min(least, distance);
    }
    node = best;
  }
  return tree.nodes[node].weight;
}

void expect_same_tree(const Vocabulary& vocabulary, const DbowTree& tree) {
  EXPECT_EQ(vocabulary.node_count(), tree.nodes.size());
  EXPECT_EQ(vocabulary.depth(), 3);
  EXPECT_EQ(vocabulary.branching(), 4);
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const OrbDescriptor descriptor = place_test::random_descriptor(random);
    EXPECT_FLOAT_EQ(vocabulary.weight(vocabulary.word(descriptor)),
                    static_cast<float>(weight_by_descent(tree, descriptor)));
  }
}

std::string message_of(const Bytes& bytes) {
  try {
    parse_vocabulary(bytes, "some.file");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_message(const Bytes& bytes, const std::string& part) {
  const std::string message = message_of(bytes);
  EXPECT_TRUE(message.starts_with("some.file")) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

/// The text with line `number` (from 1) replaced.
Bytes with_line(const Bytes& text, int number, const std::string& replacement) {
  std::istringstream in(std::string(text.begin(), text.end()));
  std::string result, line;
  for (int i = 1; std::getline(in, line); ++i) result += (i == number ? replacement : line) + "\n";
  return {result.begin(), result.end()};
}

TEST(DbowVocabularyFile, ReadsTheTextOfDbow2) {
  const DbowTree tree;
  expect_same_tree(parse_vocabulary(text_file(tree), "a"), tree);
  expect_same_tree(parse_vocabulary(text_file(tree, "\r\n"), "a"), tree);
  expect_same_tree(parse_vocabulary(text_file(tree, " \n\n"), "a"), tree);
}

TEST(DbowVocabularyFile, ReadsTheBinaryOfDbow3) {
  const DbowTree tree;
  expect_same_tree(parse_vocabulary(binary_file(tree), "a"), tree);
}

TEST(DbowVocabularyFile, BothGiveTheSameVocabulary) {
  const DbowTree tree;
  const Vocabulary text = parse_vocabulary(text_file(tree), "a"), binary = parse_vocabulary(binary_file(tree), "a");
  EXPECT_NE(text.origin().find("DBoW2"), std::string::npos);
  EXPECT_NE(binary.origin().find("DBoW3"), std::string::npos);
  std::mt19937_64 random(4);
  for (int i = 0; i < 100; ++i) {
    const OrbDescriptor descriptor = place_test::random_descriptor(random);
    EXPECT_FLOAT_EQ(text.weight(text.word(descriptor)), binary.weight(binary.word(descriptor)));
  }
  // Own format, there and back.
  EXPECT_EQ(vocabulary_bytes(parse_vocabulary(vocabulary_bytes(text), "a")), vocabulary_bytes(text));
}

TEST(DbowVocabularyFile, DamagedText) {
  const Bytes good = text_file(DbowTree());
  const std::string node = "0 1 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32";
  EXPECT_EQ(message_of(with_line(good, 99, node + " 1.5")), "");
  expect_message(with_line(good, 9, node), "some.file:9: ");  // Without weight.
  expect_message(with_line(good, 9, node + " 1.5 7"), "weight");
  expect_message(with_line(good, 9, node + " much"), "weight");
  expect_message(with_line(good, 9, "99" + node.substr(1) + " 1.5"), "some.file:9: the node hangs on a later one");
  expect_message(with_line(good, 9, "0 1 1 2 3 256 5"), "byte 4");
  expect_message(with_line(good, 9, "0 1 1 2 3 -4 5"), "byte 4");
  expect_message(with_line(good, 9, "nothing"), "some.file:9");
  expect_message(with_line(good, 9, node + " -1"), "weight");
  expect_message(with_line(good, 9, node + " nan"), "weight");
  expect_message(with_line(good, 1, "4 3 0"), "is no vocabulary");
  expect_message({'4', ' ', '3', ' ', '0', ' ', '0', '\n'}, "no leaf");
  // Cut in the middle of a line, and at the end of one.
  expect_message({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(good.size() / 2)}, "some.file:");
  Bytes first_nodes = good;
  int lines = 0;
  first_nodes.erase(
      std::find_if(first_nodes.begin(), first_nodes.end(), [&](auto c) { return (lines += c == '\n') == 4; }),
      first_nodes.end());
  expect_message(first_nodes, "truncated");
}

TEST(DbowVocabularyFile, DamagedBinary) {
  const Bytes good = binary_file(DbowTree());
  ASSERT_EQ(message_of(good), "");
  for (std::size_t length = 1; length < good.size(); length += 13)
    EXPECT_NE(message_of({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), "") << length;
  const auto with_byte = [&](std::size_t position, std::uint8_t byte) {
    Bytes damaged = good;
    damaged[position] = byte;
    return damaged;
  };
  constexpr std::size_t kFirstNode = 8 + 1 + 4 + 16;
  expect_message(with_byte(8, 1), "compressed");
  expect_message(with_byte(12, 200), "truncated");                   // Number of nodes.
  expect_message(with_byte(kFirstNode, 0), "number of a node");      // The root comes again.
  expect_message(with_byte(kFirstNode + 3, 9), "number of a node");  // A node beyond the last.
  expect_message(with_byte(kFirstNode + 5, 9), "number of a node");  // Its parent.
  expect_message(with_byte(kFirstNode + 60, good[kFirstNode]), "twice");
  expect_message(with_byte(kFirstNode + 16, 64), "256 bits");
  expect_message(with_byte(kFirstNode + 24, 5), "256 bits");
  expect_message(with_byte(good.size() - 4, 1), "node of a word");  // An inner node.
  const DbowTree tree;
  const auto words = std::count_if(tree.nodes.begin(), tree.nodes.end(), [](auto& n) { return n.is_leaf; });
  const std::size_t last_node = good.size() - 8 * static_cast<std::size_t>(words) - 4 - 60;
  expect_message(with_byte(last_node + 15, 0xff), "weight");  // Negative.
  Bytes longer = good;
  longer.push_back(0);
  expect_message(longer, "behind its end");
}

TEST(DbowVocabularyFile, NoDamageCrashes) {
  std::mt19937_64 random(12);
  for (const Bytes& good : {binary_file(DbowTree()), text_file(DbowTree())}) {
    for (int i = 0; i < 2000; ++i) {
      Bytes damaged = good;
      for (int j = 0; j < 3; ++j) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      try {
        parse_vocabulary(damaged, "a").word({});  // May still be a tree.
      } catch (const Error&) {
      }
    }
  }
}

}  // namespace
}  // namespace ldso
