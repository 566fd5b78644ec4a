#pragma once

// Files inside the program: the assembler puts them as they are between two symbols; compiled from source text they
// would take the compiler minutes.

#ifdef __APPLE__
#define LDSO_SECTION ".const_data"
#define LDSO_SYMBOL(name) "_" name
#else
#define LDSO_SECTION ".section .rodata"
#define LDSO_SYMBOL(name) name
#endif

/// At namespace scope, in one source: the bytes of `file` (a string literal) are those from name_begin to name_end, and
/// a zero follows them.
#define LDSO_EMBED_FILE(name, file)                                                                                    \
  __asm__(LDSO_SECTION "\n.globl " LDSO_SYMBOL(#name "_begin") "\n.globl " LDSO_SYMBOL(#name "_end") "\n" LDSO_SYMBOL( \
      #name "_begin") ":\n.incbin \"" file "\"\n" LDSO_SYMBOL(#name "_end") ":\n.byte 0\n.text\n");                    \
  extern "C" const char name##_begin[];                                                                                \
  extern "C" const char name##_end[]
