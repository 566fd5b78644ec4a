#pragma once
// Small things with text: printf() into a string, and what two texts have in common.

#include <string>

namespace ldso {

/// The one home of formatted text. Compilers check the pattern against the arguments; std::format, which could do more,
/// comes with GCC 13 only, and a library for it would be one that the engine has to be linked with.
[[gnu::format(printf, 1, 2)]] std::string format_text(const char* pattern, ...);

/// Texts that are the same without their figures say the same of different things.
std::string without_numbers(const std::string& text);

}  // namespace ldso
