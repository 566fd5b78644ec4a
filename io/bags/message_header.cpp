#include "io/bags/message_header.h"

#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::uint32_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

std::int64_t read_stamp(WireReader& message, MessageFormat format) {
  if (format == MessageFormat::kRos1) message.number<std::uint32_t>();  // A running number.
  const auto seconds = message.number<std::uint32_t>();
  const auto nanoseconds = message.number<std::uint32_t>();
  if (nanoseconds >= kNanosecondsPerSecond) throw Error(message.where(), "the time in the header is none", "");
  return std::int64_t{seconds} * kNanosecondsPerSecond + nanoseconds;
}

MessageHeader read_header(WireReader& message, MessageFormat format) {
  MessageHeader header;
  header.time_ns = read_stamp(message, format);
  header.frame = message.text();
  return header;
}

}  // namespace ldso
