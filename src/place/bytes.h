#pragma once

// Little-endian numbers from and to bytes, whatever the machine; reading beyond the end is an Error, not a crash.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ldso/error.h"
#include "place/feature.h"

namespace ldso {

class VocabularyReader {
 public:
  VocabularyReader(std::span<const std::uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  template <class Unsigned>
  Unsigned number() {
    static_assert(std::is_unsigned_v<Unsigned>);
    const std::span<const std::uint8_t> raw = take(sizeof(Unsigned));
    Unsigned value = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) value |= static_cast<Unsigned>(Unsigned{raw[i]} << (8 * i));
    return value;
  }
  float float32() { return std::bit_cast<float>(number<std::uint32_t>()); }
  double float64() { return std::bit_cast<double>(number<std::uint64_t>()); }

  OrbDescriptor descriptor() {
    OrbDescriptor descriptor;
    for (std::uint64_t& word : descriptor.bits) word = number<std::uint64_t>();
    return descriptor;
  }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > bytes_.size()) fail("the file is truncated");
    const std::span<const std::uint8_t> taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }

  std::size_t left() const { return bytes_.size(); }
  const std::string& name() const { return name_; }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(name_, problem, "copy it again or train the vocabulary anew (ldso vocab train)");
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::string name_;
};

template <class Unsigned>
void append_number(Unsigned value, std::vector<std::uint8_t>& bytes) {
  static_assert(std::is_unsigned_v<Unsigned>);
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void append_descriptor(const OrbDescriptor& descriptor, std::vector<std::uint8_t>& bytes) {
  for (const std::uint64_t word : descriptor.bits) append_number(word, bytes);
}

}  // namespace ldso
