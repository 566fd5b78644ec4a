#pragma once

// What the readers of binary vocabularies share.

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "place/feature.h"
#include "util/bytes.h"

namespace ldso {

class VocabularyReader : public ByteReader {
 public:
  VocabularyReader(std::span<const std::uint8_t> bytes, std::string name)
      : ByteReader(bytes, std::move(name), "the file is truncated",
                   "copy it again or train the vocabulary anew (ldso vocab train)") {}

  OrbDescriptor descriptor() {
    OrbDescriptor descriptor;
    for (std::uint64_t& word : descriptor.bits) word = get<std::uint64_t>();
    return descriptor;
  }
};

}  // namespace ldso
