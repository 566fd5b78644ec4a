#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ldso {

enum class Packing { kNone, kBz2, kLz4, kZstd };

/// Of "none", "", "bz2", "lz4" or "zstd", as bags call them; nothing of another one.
std::optional<Packing> packing_of(const std::string& name);

struct Unpacked {
  std::vector<std::uint8_t> bytes;
  std::string problem;  ///< Why these are not all, if they are not: the data are cut off, damaged or too large.
};

/// What was packed, as far as it can be had: at most `most` bytes.
Unpacked unpack(Packing packing, std::span<const std::uint8_t> packed, std::size_t most);

}  // namespace ldso
