#pragma once

// Numbers that nobody can guess, from the system.

#include <cstdint>
#include <string>

namespace ldso {

std::uint64_t random_id();

/// 128 random bits in hexadecimal digits.
std::string make_token();

}  // namespace ldso
