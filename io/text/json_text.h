#pragma once

// JSON that others may have written, and JSON that is always written.

#include <cmath>
#include <concepts>
#include <limits>
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

/// A value as the library converts it, but for whole numbers: what is none, or has no room in `Value`, throws what the
/// library throws for a value of another kind. (It would convert 1e300 to an int, which is undefined.)
template <class Value, class Json>
Value json_value(const Json& json) {
  if constexpr (std::integral<Value> && !std::same_as<Value, bool>) {
    const auto number = json.template get<double>();
    const bool fits = number >= static_cast<double>(std::numeric_limits<Value>::min()) &&
                      number < static_cast<double>(std::numeric_limits<Value>::max()) && number == std::floor(number);
    if (!fits) throw Json::out_of_range::create(406, "a whole number is expected", &json);
  }
  return json.template get<Value>();
}

/// As JSON. Texts that are no UTF-8, names of files for instance, are written as far as they can be: results must not
/// be lost for an odd name. `Json`: one of nlohmann's.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ldso
