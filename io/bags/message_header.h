#pragma once

#include <cstdint>
#include <string>

#include "io/bags/wire_reader.h"

namespace ldso {

/// The beginning of every message of a sensor: std_msgs/Header.
struct MessageHeader {
  std::int64_t time_ns = 0;  ///< When it was measured, by the sensor's driver; 0: it does not say.
  std::string frame;         ///< Of coordinates, which tells cameras apart.
};

/// Of a message's first 16 bytes. Throws Error if they are not there or the time is none.
std::int64_t read_stamp(WireReader& message, MessageFormat format);

/// Throws Error if it is cut off.
MessageHeader read_header(WireReader& message, MessageFormat format);

inline constexpr std::size_t kStampBytes = 16;

}  // namespace ldso
