#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ldso {

// Values one after the other in bytes, as bags and the messages in them have them. Nothing is taken on the word of a
// length: what is not there is an Error.

/// How a message is serialized.
enum class MessageFormat {
  kRos1,   ///< Little endian, packed.
  kCdr,    ///< ROS 2: OMG's Common Data Representation, aligned, in the byte order that its first bytes name.
  kOther,  ///< One that is not read here.
};

class WireReader {
 public:
  /// Little endian and packed, as in the records of bags. `where` is what messages call it.
  WireReader(std::span<const std::uint8_t> bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  /// A message. Throws Error if its bytes begin with what is no head of its format.
  WireReader(std::span<const std::uint8_t> message, MessageFormat format, std::string where);

  /// The next number, of a type of 1 to 8 bytes.
  template <class T>
  T number() {
    align(sizeof(T));
    std::array<std::uint8_t, sizeof(T)> raw;
    const std::span<const std::uint8_t> next = bytes(sizeof(T));
    std::copy(next.begin(), next.end(), raw.begin());
    if (is_big_endian_ != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  /// Four bytes of length and the characters; without the zero at the end that CDR counts in.
  std::string text();
  /// Four bytes of length and as many bytes.
  std::span<const std::uint8_t> sequence();
  std::span<const std::uint8_t> bytes(std::size_t count);

  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  const std::string& where() const { return where_; }

 private:
  void align(std::size_t size);

  std::span<const std::uint8_t> bytes_;
  std::string where_;
  std::size_t position_ = 0;
  std::size_t most_alignment_ = 1;  ///< CDR aligns numbers to their own size, up to this.
  bool is_big_endian_ = false;
};

}  // namespace ldso
