#pragma once

// Little-endian bytes: written in order, read back with checks.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ldso/error.h"

namespace ldso {

static_assert(std::endian::native == std::endian::little, "the messages are little-endian and written as they are");

using Bytes = std::vector<std::uint8_t>;

class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof(T));
  }
  void put_bytes(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void put_text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  /// Zeros up to the next multiple of `unit`.
  void align(std::size_t unit) { bytes_.resize((bytes_.size() + unit - 1) / unit * unit, 0); }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  /// Overwrites what was put at `offset`.
  template <class T>
  void patch(std::size_t offset, const T& value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof(T));
  }

  std::size_t size() const { return bytes_.size(); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Throws Error, with `name` as the context, where there is less than what is asked for.
class ByteReader {
 public:
  ByteReader(std::span<const std::uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, get_bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::span<const std::uint8_t> get_bytes(std::size_t count) {
    if (count > left()) throw Error(name_, "it ends too early", "it is damaged or incomplete");
    const auto result = bytes_.subspan(at_, count);
    at_ += count;
    return result;
  }
  std::string get_text(std::size_t count) {
    const auto bytes = get_bytes(count);
    return {bytes.begin(), bytes.end()};
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace ldso
