#include "io/bags/wire_reader.h"

#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

/// In front of a message in CDR: what it is, and options. Alignment counts from behind it.
constexpr std::size_t kCdrHead = 4;

}  // namespace

WireReader::WireReader(std::span<const std::uint8_t> message, MessageFormat format, std::string where)
    : WireReader(message, std::move(where)) {
  if (format == MessageFormat::kRos1) return;
  const std::span<const std::uint8_t> head = bytes(kCdrHead);
  // Plain CDR of version 1, or of version 2, which aligns to four bytes at most; odd numbers are little endian.
  const bool is_first = head[0] == 0 && head[1] <= 1;
  const bool is_second = head[0] == 0 && (head[1] == 6 || head[1] == 7);
  if (format != MessageFormat::kCdr || (!is_first && !is_second))
    throw Error(where_, "the message is serialized in a way that is not read", "plain CDR and ROS 1 are");
  most_alignment_ = is_first ? 8 : 4;
  is_big_endian_ = head[1] % 2 == 0;
  bytes_ = bytes_.subspan(kCdrHead);
  position_ = 0;
}

void WireReader::align(std::size_t size) {
  const std::size_t step = std::min(size, most_alignment_);
  const std::size_t aligned = (position_ + step - 1) / step * step;
  if (aligned > position_) bytes(aligned - position_);
}

std::string WireReader::text() {
  const std::span<const std::uint8_t> raw = sequence();
  std::string text(raw.begin(), raw.end());
  if (most_alignment_ > 1 && !text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

std::span<const std::uint8_t> WireReader::sequence() { return bytes(number<std::uint32_t>()); }

std::span<const std::uint8_t> WireReader::bytes(std::size_t count) {
  if (count > remaining()) {
    throw Error(where_,
                "it is cut off: " + std::to_string(count) + " bytes are announced, " + std::to_string(remaining()) +
                    " are there",
                "");
  }
  const std::span<const std::uint8_t> result = bytes_.subspan(position_, count);
  position_ += count;
  return result;
}

}  // namespace ldso
