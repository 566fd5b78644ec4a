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
        ".globl " LDSO_SYMBOL("ldso_vocabulary_begin") "\n"
        ".globl " LDSO_SYMBOL("ldso_vocabulary_end") "\n"
        LDSO_SYMBOL("ldso_vocabulary_begin") ":\n"
        ".incbin \"" LDSO_VOCABULARY_FILE "\"\n"
        LDSO_SYMBOL("ldso_vocabulary_end") ":\n"
        ".byte 0\n"
        ".text\n");

extern "C" {
extern const std::uint8_t ldso_vocabulary_begin[];
extern const std::uint8_t ldso_vocabulary_end[];
}

namespace ldso {

Vocabulary default_vocabulary() {
  return parse_vocabulary(std::span(ldso_vocabulary_begin, ldso_vocabulary_end), "the built-in vocabulary");
}

}  // namespace ldso
