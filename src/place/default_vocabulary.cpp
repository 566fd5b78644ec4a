#include "place/default_vocabulary.h"

#include <cstdint>
#include <span>

#include "place/vocabulary_file.h"

// The assembler puts the file as it is between two symbols; compiled from source text it would take the compiler
// minutes. LDSO_VOCABULARY_FILE comes from CMakeLists.txt.
#ifdef __APPLE__
#define LDSO_SECTION ".const_data"
#define LDSO_SYMBOL(name) "_" name
#else
#define LDSO_SECTION ".section .rodata"
#define LDSO_SYMBOL(name) name
#endif
__asm__(LDSO_SECTION
        "\n"
        ".globl " LDSO_SYMBOL("kLdsoVocabularyBegin") "\n"
        ".globl " LDSO_SYMBOL("kLdsoVocabularyEnd") "\n"
        LDSO_SYMBOL("kLdsoVocabularyBegin") ":\n"
        ".incbin \"" LDSO_VOCABULARY_FILE "\"\n"
        LDSO_SYMBOL("kLdsoVocabularyEnd") ":\n"
        ".byte 0\n"
        ".text\n");

extern "C" {
extern const std::uint8_t kLdsoVocabularyBegin[];
extern const std::uint8_t kLdsoVocabularyEnd[];
}

namespace ldso {

Vocabulary default_vocabulary() {
  return parse_vocabulary(std::span(kLdsoVocabularyBegin, kLdsoVocabularyEnd), "the built-in vocabulary");
}

}  // namespace ldso
