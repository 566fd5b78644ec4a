#pragma once

#include <array>
#include <cstdint>

namespace ldso {

/// Red, green, blue.
using Rgb = std::array<std::uint8_t, 3>;

}  // namespace ldso
