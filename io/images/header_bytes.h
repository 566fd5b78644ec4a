#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ldso {

/// The bytes of an image file by offset, in either byte order. What lies behind their end is zero: a header that points
/// there says nothing.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::uint8_t> all() const { return bytes_; }
  std::int64_t at(std::size_t offset) const { return offset < bytes_.size() ? bytes_[offset] : 0; }

  std::int64_t big(std::size_t offset, std::size_t count) const {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | at(offset + i);
    return value;
  }
  std::int64_t little(std::size_t offset, std::size_t count) const {
    std::int64_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | at(offset + i);
    return value;
  }
  bool has(std::size_t offset, std::string_view text) const {
    if (offset > bytes_.size() || bytes_.size() - offset < text.size()) return false;
    return std::equal(text.begin(), text.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace ldso
