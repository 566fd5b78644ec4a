#include "place/dbow_vocabulary_file.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "ldso/error.h"
#include "place/vocabulary_reader.h"

namespace ldso {
namespace {

/// What binary files of DBoW3 begin with.
constexpr std::uint64_t kDbow3Signature = 88877711233ULL;
/// Of an ORB descriptor.
constexpr std::uint32_t kDescriptorBytes = 32;
/// Bytes of a node in such a file: id, parent, weight, three numbers on its descriptor, and the descriptor.
constexpr std::size_t kDbow3NodeSize = 4 + 4 + 8 + 3 * 4 + kDescriptorBytes;

/// Numbers of a text, line by line. std::from_chars: ORBvoc.txt has 36 million of them.
class NumberText {
 public:
  NumberText(std::span<const std::uint8_t> bytes, std::string name)
      : rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(std::move(name)) {}

  /// Goes to the next line that is not blank; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
      ++number_;
      skip_blanks();
      if (!line_.empty()) return true;
    }
    return false;
  }

  template <class Number>
  std::optional<Number> next() {
    Number value{};
    const auto [end, error] = std::from_chars(line_.data(), line_.data() + line_.size(), value);
    if (error != std::errc{}) return std::nullopt;
    line_.remove_prefix(static_cast<std::size_t>(end - line_.data()));
    if (!line_.empty() && !is_blank(line_.front())) return std::nullopt;
    skip_blanks();
    return value;
  }

  bool line_is_done() const { return line_.empty(); }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(name_ + ":" + std::to_string(number_), problem,
                "copy the file again; each line but the first is `parent is_leaf`, 32 bytes, `weight`");
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  void skip_blanks() {
    while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
  }

  std::string_view rest_, line_;
  std::string name_;
  int number_ = 0;
};

struct DbowHeader {
  std::int32_t branching = 0, depth = 0, scoring = 0, weighting = 0;
};

std::optional<DbowHeader> read_header(NumberText& text) {
  if (!text.next_line()) return std::nullopt;
  DbowHeader header;
  for (std::int32_t* field : {&header.branching, &header.depth, &header.scoring, &header.weighting}) {
    const auto value = text.next<std::int32_t>();
    if (!value) return std::nullopt;
    *field = *value;
  }
  return text.line_is_done() ? std::optional(header) : std::nullopt;
}

std::string describe(const std::string& format, const DbowHeader& header) {
  return format + ", k = " + std::to_string(header.branching) + ", L = " + std::to_string(header.depth);
}

struct TextNode {
  VocabularyNode node;
  bool is_leaf = false;
};

TextNode parse_text_node(NumberText& text, std::size_t nodes_so_far) {
  TextNode parsed;
  const auto parent = text.next<std::uint32_t>();
  const auto is_leaf = text.next<int>();
  if (!parent || !is_leaf) text.fail("the line does not begin with two whole numbers");
  if (*parent >= nodes_so_far) text.fail("the node hangs on a later one");
  parsed.node.parent = *parent;
  parsed.is_leaf = *is_leaf != 0;
  for (std::uint32_t i = 0; i < kDescriptorBytes; ++i) {
    const auto byte = text.next<std::uint32_t>();
    if (!byte || *byte > 255) text.fail("byte " + std::to_string(i + 1) + " of the descriptor is missing or no byte");
    parsed.node.descriptor.bits[i / 8] |= std::uint64_t{*byte} << (8 * (i % 8));
  }
  const auto weight = text.next<double>();
  if (!weight || !text.line_is_done()) text.fail("the line does not end with one weight");
  parsed.node.weight = static_cast<float>(*weight);
  return parsed;
}

VocabularyNode parse_binary_node(VocabularyReader& reader, std::uint32_t node_count, std::uint32_t& id) {
  VocabularyNode node;
  id = reader.get<std::uint32_t>();
  node.parent = reader.get<std::uint32_t>();
  node.weight = static_cast<float>(reader.get<double>());
  const auto columns = reader.get<std::uint32_t>(), rows = reader.get<std::uint32_t>();
  const auto type = reader.get<std::uint32_t>();
  if (id == 0 || id >= node_count || node.parent >= node_count) reader.fail("the file is damaged (number of a node)");
  if (columns != kDescriptorBytes || rows != 1 || type != 0) {
    throw Error(reader.name(), "its descriptors are not of 256 bits, or it is damaged",
                "take a vocabulary of ORB descriptors");
  }
  node.descriptor = reader.descriptor();
  return node;
}

/// Checks that words are leaves and leaves words.
void check_words(VocabularyReader& reader, const std::vector<VocabularyNode>& nodes) {
  std::vector<char> is_leaf(nodes.size(), 1);
  is_leaf[0] = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) is_leaf[nodes[i].parent] = 0;
  std::size_t leaves = 0;
  for (const char leaf : is_leaf) leaves += leaf != 0;
  const auto words = reader.get<std::uint32_t>();
  if (words != leaves) reader.fail("the file is damaged (number of words)");
  for (std::uint32_t i = 0; i < words; ++i) {
    reader.get<std::uint32_t>();  // The word's number there; words are numbered anew.
    const auto node = reader.get<std::uint32_t>();
    if (node >= nodes.size() || is_leaf[node] != 1) reader.fail("the file is damaged (node of a word)");
    is_leaf[node] = 2;
  }
}

}  // namespace

bool is_dbow3_binary(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 8 && VocabularyReader(bytes, "").get<std::uint64_t>() == kDbow3Signature;
}

Vocabulary parse_dbow3_binary(std::span<const std::uint8_t> bytes, const std::string& name) {
  VocabularyReader reader(bytes, name);
  reader.get<std::uint64_t>();
  if (reader.get<std::uint8_t>() != 0) {
    throw Error(name, "is a compressed file of DBoW3, which cannot be read",
                "save it again with DBoW3's `vocabulary.save(name, false)`");
  }
  const auto node_count = reader.get<std::uint32_t>();
  DbowHeader header;
  for (std::int32_t* field : {&header.branching, &header.depth, &header.scoring, &header.weighting})
    *field = static_cast<std::int32_t>(reader.get<std::uint32_t>());
  if (node_count < 2) throw Error(name, "has no words", "take another vocabulary");
  if (reader.left() / kDbow3NodeSize < node_count - 1) reader.fail("the file is truncated");
  std::vector<VocabularyNode> nodes(node_count);
  std::vector<char> seen(node_count, 0);
  for (std::uint32_t i = 1; i < node_count; ++i) {
    std::uint32_t id = 0;
    const VocabularyNode node = parse_binary_node(reader, node_count, id);
    if (seen[id] != 0) reader.fail("the file is damaged (node " + std::to_string(id) + " comes twice)");
    seen[id] = 1;
    nodes[id] = node;
  }
  check_words(reader, nodes);
  if (reader.left() != 0) reader.fail("there is something behind its end");
  return Vocabulary(nodes, describe("DBoW3 binary", header));
}

bool is_dbow2_text(std::span<const std::uint8_t> bytes) {
  NumberText text(bytes.first(std::min<std::size_t>(bytes.size(), 256)), "");
  return read_header(text).has_value();
}

Vocabulary parse_dbow2_text(std::span<const std::uint8_t> bytes, const std::string& name) {
  NumberText text(bytes, name);
  const std::optional<DbowHeader> header = read_header(text);
  if (!header) text.fail("the first line is not `k L scoring weighting`");
  std::vector<VocabularyNode> nodes(1);
  std::vector<char> is_leaf{0};
  while (text.next_line()) {
    const TextNode parsed = parse_text_node(text, nodes.size());
    if (is_leaf[parsed.node.parent] != 0) text.fail("the node hangs on a leaf");
    nodes.push_back(parsed.node);
    is_leaf.push_back(parsed.is_leaf ? 1 : 0);
  }
  // A file that was cut at the end of a line has inner nodes without children.
  std::vector<char> has_child(nodes.size(), 0);
  for (std::size_t i = 1; i < nodes.size(); ++i) has_child[nodes[i].parent] = 1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (has_child[i] == 0 && is_leaf[i] == 0) {
      throw Error(name, "the file is truncated: node " + std::to_string(i) + " is no leaf, but nothing hangs on it",
                  "copy it again");
    }
  }
  return Vocabulary(nodes, describe("DBoW2 text", *header));
}

}  // namespace ldso
