#include "util/format_text.h"

#include <cctype>
#include <cstdarg>
#include <cstdio>

namespace ldso {

std::string format_text(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof(text), pattern, arguments);
  va_end(arguments);
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
