#pragma once
// Small things with text: printf() into a string, and what two texts have in common.

#include <string>

namespace ldso {

/// At most 511 characters.
[[gnu::format(printf, 1, 2)]] std::string format_text(const char* pattern, ...);

/// Texts that are the same without their figures say the same of different things.
std::string without_numbers(const std::string& text);

}  // namespace ldso
