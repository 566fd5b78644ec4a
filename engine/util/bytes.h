#pragma once

// Little-endian numbers to and from bytes, whatever the machine: written in order, read back with checks.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "ldso/error.h"

namespace ldso {

using Bytes = std::vector<std::uint8_t>;

/// The unsigned integer with as many bytes as an arithmetic type.
template <class T>
using UnsignedLike =
    std::conditional_t<sizeof(T) == 1, std::uint8_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                          std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
std::array<std::uint8_t, sizeof(T)> to_bytes(const T& value) {
  static_assert(std::is_arithmetic_v<T>);
  const auto bits = std::bit_cast<UnsignedLike<T>>(value);
  std::array<std::uint8_t, sizeof(T)> bytes;
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  return bytes;
}

class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    put_bytes(to_bytes(value));
  }
  void put_bytes(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void put_text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  /// Zeros up to the next multiple of `unit`.
  void align(std::size_t unit) { bytes_.resize((bytes_.size() + unit - 1) / unit * unit, 0); }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  /// Overwrites what was put at `offset`.
  template <class T>
  void patch(std::size_t offset, const T& value) {
    const auto bytes = to_bytes(value);
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
  }

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::uint8_t> bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Throws Error, with `name` as the context, the problem `too_short` and `remedy`, where there is less than what is
/// asked for.
class ByteReader {
 public:
  ByteReader(std::span<const std::uint8_t> bytes, std::string name, std::string too_short = "it ends too early",
             std::string remedy = "it is damaged or incomplete")
      : bytes_(bytes), name_(std::move(name)), too_short_(std::move(too_short)), remedy_(std::move(remedy)) {}

  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    const std::span<const std::uint8_t> raw = get_bytes(sizeof(T));
    UnsignedLike<T> bits = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      bits = static_cast<UnsignedLike<T>>(bits | static_cast<UnsignedLike<T>>(UnsignedLike<T>{raw[i]} << (8 * i)));
    }
    return std::bit_cast<T>(bits);
  }
  std::span<const std::uint8_t> get_bytes(std::size_t count) {
    if (count > bytes_.size()) fail(too_short_);
    const std::span<const std::uint8_t> taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  std::string get_text(std::size_t count) {
    const auto bytes = get_bytes(count);
    return {bytes.begin(), bytes.end()};
  }

  std::size_t left() const { return bytes_.size(); }
  const std::string& name() const { return name_; }

  [[noreturn]] void fail(const std::string& problem) const { throw Error(name_, problem, remedy_); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::string too_short_;
  std::string remedy_;
};

}  // namespace ldso
