#include "place/vocabulary_file.h"

#include <algorithm>
#include <string_view>

#include "ldso/error.h"
#include "place/dbow_vocabulary_file.h"
#include "place/vocabulary_reader.h"
#include "util/hash.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// Of the format.
constexpr std::uint32_t kVersion = 1;
/// Bytes at the end of a file.
constexpr std::size_t kChecksumSize = 8;

std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  Checksum checksum;
  for (const std::uint8_t byte : bytes) checksum.add(byte);
  return checksum.value();
}

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::equal(text.begin(), text.end(), bytes.begin(), [](char a, std::uint8_t b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

/// The parents that the numbers of children tell, level after level.
void set_parents(std::span<const std::uint8_t> child_counts, VocabularyReader& reader,
                 std::vector<VocabularyNode>& nodes) {
  std::size_t next = 1;
  for (std::size_t parent = 0; parent < nodes.size(); ++parent) {
    if (child_counts[parent] > nodes.size() - next) reader.fail("its nodes do not fit together");
    for (int i = 0; i < child_counts[parent]; ++i) nodes[next++].parent = static_cast<std::uint32_t>(parent);
  }
  if (next != nodes.size()) reader.fail("its nodes do not fit together");
}

Vocabulary parse_own(std::span<const std::uint8_t> bytes, const std::string& name) {
  VocabularyReader reader(bytes, name);
  reader.get_bytes(kVocabularyMagic.size());
  const auto version = reader.get<std::uint32_t>();
  if (version != kVersion)
    throw Error(name, "is a vocabulary of format version " + std::to_string(version), "update ldso to read it");
  const auto node_count = reader.get<std::uint32_t>();
  const auto word_count = reader.get<std::uint32_t>();
  const auto origin_size = reader.get<std::uint32_t>();
  const std::uint64_t expected =
      std::uint64_t{origin_size} + std::uint64_t{node_count} * 33 - 32 + std::uint64_t{word_count} * 4 + kChecksumSize;
  if (node_count == 0 || reader.left() < expected) reader.fail("the file is truncated");
  if (reader.left() > expected) reader.fail("there is something behind its end");
  VocabularyReader checksum(bytes.last(kChecksumSize), name);
  if (checksum.get<std::uint64_t>() != checksum_of(bytes.first(bytes.size() - kChecksumSize)))
    reader.fail("the file is damaged (its checksum is wrong)");

  const auto origin = reader.get_bytes(origin_size);
  const auto child_counts = reader.get_bytes(node_count);
  std::vector<VocabularyNode> nodes(node_count);
  set_parents(child_counts, reader, nodes);
  for (std::size_t i = 1; i < nodes.size(); ++i) nodes[i].descriptor = reader.descriptor();
  if (std::count(child_counts.begin(), child_counts.end(), 0) != static_cast<std::ptrdiff_t>(word_count))
    reader.fail("its words do not fit its nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (child_counts[i] == 0) nodes[i].weight = reader.get<float>();
  }
  return Vocabulary(nodes, std::string(origin.begin(), origin.end()));
}

}  // namespace

Vocabulary parse_vocabulary(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.empty()) throw Error(name, "the file is empty", "copy it again or train a vocabulary (ldso vocab train)");
  try {
    if (starts_with(bytes, kVocabularyMagic)) return parse_own(bytes, name);
    if (is_dbow3_binary(bytes)) return parse_dbow3_binary(bytes, name);
    if (is_dbow2_text(bytes)) return parse_dbow2_text(bytes, name);
  } catch (const Error& error) {
    // Errors of the tree itself do not know the file.
    if (std::string_view(error.what()).starts_with(name)) throw;
    throw Error(name + ": " + error.what());
  }
  throw Error(name, "is no vocabulary",
              "give one made by `ldso vocab train`, an uncompressed binary file of DBoW3 or a text file of DBoW2");
}

Vocabulary read_vocabulary(const fs::path& path) {
  const std::string content = read_file(path);
  return parse_vocabulary({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()}, path.string());
}

std::vector<std::uint8_t> vocabulary_bytes(const Vocabulary& vocabulary) {
  if (vocabulary.branching() > 255)
    throw Error("vocabulary", "a node has more than 255 children", "train it with a smaller branching");
  ByteWriter out;
  out.put_text(kVocabularyMagic);
  out.put(kVersion);
  out.put(static_cast<std::uint32_t>(vocabulary.node_count()));
  out.put(static_cast<std::uint32_t>(vocabulary.word_count()));
  out.put(static_cast<std::uint32_t>(vocabulary.origin().size()));
  out.put_text(vocabulary.origin());
  for (NodeId node = 0; node < vocabulary.node_count(); ++node) {
    const auto [begin, end] = vocabulary.children(node);
    out.put(static_cast<std::uint8_t>(end - begin));
  }
  for (NodeId node = 1; node < vocabulary.node_count(); ++node) {
    for (const std::uint64_t word : vocabulary.descriptor(node).bits) out.put(word);
  }
  for (WordId word = 0; word < vocabulary.word_count(); ++word) out.put(vocabulary.weight(word));
  out.put(checksum_of(out.bytes()));
  return out.take();
}

void write_vocabulary(const fs::path& path, const Vocabulary& vocabulary) {
  const std::vector<std::uint8_t> bytes = vocabulary_bytes(vocabulary);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace ldso
