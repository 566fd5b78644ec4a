// Vocabularies: our own files and DBoW's. The checksum at the end of our own is set right first, or nothing behind it
// would ever be reached.

#include <algorithm>
#include <span>

#include "fuzz_target.h"
#include "place/vocabulary_file.h"
#include "util/hash.h"

using namespace ldso;

namespace {

void set_checksum(std::vector<std::uint8_t>& bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(kVocabularyMagic) || bytes.size() < kVocabularyMagic.size() + sizeof(std::uint64_t)) return;
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  Checksum checksum;
  for (std::size_t i = 0; i < end; ++i) checksum.add(bytes[i]);
  for (std::size_t i = 0; i < sizeof(std::uint64_t); ++i)
    bytes[end + i] = static_cast<std::uint8_t>(checksum.value() >> (8 * i));
}

}  // namespace

LDSO_FUZZ_TARGET(vocabulary) {
  std::vector<std::uint8_t> bytes(input.begin(), input.end());
  set_checksum(bytes);
  const auto vocabulary = fuzz::accepted([&] { return parse_vocabulary(bytes, "vocabulary"); });
  if (!vocabulary) return;
  fuzz::expect(vocabulary->word_count() > 0 && vocabulary->depth() <= Vocabulary::kMaxDepth, "there is a word");
  OrbDescriptor descriptor;
  for (std::uint64_t& word : descriptor.bits) word = 0x5555555555555555;
  const WordId word = vocabulary->word(descriptor);
  fuzz::expect(word < vocabulary->word_count(), "a descriptor has a word of the vocabulary");
  for (int level = 0; level <= vocabulary->depth() + 1; ++level) vocabulary->node_at_level(word, level);
  for (const auto& [id, weight] : vocabulary->bow_vector(std::vector<WordId>{word}))
    fuzz::expect(std::isfinite(weight), "a weight is finite");
  const auto written = fuzz::accepted([&] { return vocabulary_bytes(*vocabulary); });
  if (written)
    fuzz::expect(vocabulary_bytes(parse_vocabulary(*written, "again")) == *written, "it reads back as it was");
}
