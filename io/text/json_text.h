#pragma once

// JSON that others may have written, and JSON that is always written.

#include <string>
#include <string_view>

#include "ldso/error.h"

namespace ldso {

/// Whether arrays and objects lie in each other more than 64 levels deep. The library copies and writes values by
/// calling itself for each level, and would run out of stack.
bool is_deep_json(std::string_view text);

/// Throws Error, with `name` as the context, if the text is too deep; what the library throws if it is no JSON.
template <class Json>
Json parse_json(const std::string& text, const std::string& name) {
  if (is_deep_json(text)) throw Error(name, "is damaged (nested more than 64 levels deep)", "write it again");
  return Json::parse(text);
}

/// As JSON. Texts that are no UTF-8, names of files for instance, are written as far as they can be: results must not
/// be lost for an odd name. `Json`: one of nlohmann's.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ldso
