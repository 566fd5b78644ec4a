#include "io/text/json_text.h"

namespace ldso {
namespace {

constexpr int kMostJsonLevels = 64;

}  // namespace

bool is_deep_json(std::string_view text) {
  int level = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') ++i;  // Whatever follows does not end it.
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') ++level;
    if (c == ']' || c == '}') --level;
    if (level > kMostJsonLevels) return true;
  }
  return false;
}

}  // namespace ldso
