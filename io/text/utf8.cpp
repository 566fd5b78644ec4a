#include "io/text/utf8.h"

#include <cstddef>
#include <cstdint>

namespace ldso {
namespace {

/// Bytes of the character that begins with `lead`, and the least number that needs so many.
struct CharacterKind {
  std::size_t bytes = 0;  ///< 0: none begins so.
  std::uint32_t least = 0;
  std::uint32_t bits = 0;  ///< Of the number that are in the first byte.
};

CharacterKind kind_of(std::uint8_t lead) {
  if (lead < 0x80) return {1, 0, lead};
  if (lead >> 5 == 0x06) return {2, 0x80, lead & 0x1fu};
  if (lead >> 4 == 0x0e) return {3, 0x800, lead & 0x0fu};
  if (lead >> 3 == 0x1e) return {4, 0x10000, lead & 0x07u};
  return {};
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const CharacterKind kind = kind_of(static_cast<std::uint8_t>(text.front()));
    if (kind.bytes == 0 || kind.bytes > text.size()) return false;
    std::uint32_t number = kind.bits;
    for (const char c : text.substr(1, kind.bytes - 1)) {
      if ((static_cast<std::uint8_t>(c) & 0xc0) != 0x80) return false;
      number = number << 6 | (static_cast<std::uint8_t>(c) & 0x3fu);
    }
    const bool is_surrogate = number >= 0xd800 && number <= 0xdfff;
    if (number < kind.least || number > 0x10ffff || is_surrogate) return false;
    text.remove_prefix(kind.bytes);
  }
  return true;
}

}  // namespace ldso
