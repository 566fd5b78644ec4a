#include "util/format_text.h"

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstdio>

namespace ldso {

std::string format_text(const char* pattern, ...) {
  va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  char start[256];  // Long enough for most.
  const int length = std::vsnprintf(start, sizeof(start), pattern, arguments);
  va_end(arguments);
  std::string text(start, length > 0 ? std::min(static_cast<std::size_t>(length), sizeof(start) - 1) : 0);
  if (length >= static_cast<int>(sizeof(start))) {
    text.resize(static_cast<std::size_t>(length));
    std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  }
  va_end(again);
  return text;
}

std::string without_numbers(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') result += c;
  }
  return result;
}

}  // namespace ldso
