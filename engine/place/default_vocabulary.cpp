#include "place/default_vocabulary.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "place/vocabulary_file.h"
#include "util/embedded_file.h"

// LDSO_VOCABULARY_FILE comes from CMakeLists.txt.
LDSO_EMBED_FILE(ldso_vocabulary, LDSO_VOCABULARY_FILE);

namespace ldso {

Vocabulary default_vocabulary() {
  const auto size = static_cast<std::size_t>(ldso_vocabulary_end - ldso_vocabulary_begin);
  const auto* first = reinterpret_cast<const std::uint8_t*>(ldso_vocabulary_begin);
  return parse_vocabulary(std::span(first, size), "the built-in vocabulary");
}

}  // namespace ldso
