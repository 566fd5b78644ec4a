#pragma once

// The value of a setting in words, as files and the command line have it.

#include <array>
#include <charconv>
#include <concepts>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "io/text/json_text.h"
#include "ldso/setting.h"

namespace ldso {

template <class Value>
std::string setting_text(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    std::array<char, 64> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return std::string(buffer.data(), end);  // The shortest text that reads back as the same number.
  } else if constexpr (std::same_as<Value, bool>) {
    return value ? "true" : "false";
  } else if constexpr (SettingChoice<Value>) {
    return std::string(word_of(value));
  } else if constexpr (std::same_as<Value, std::string>) {
    return json_text(nlohmann::json(value));  // A JSON string is a YAML string.
  } else {
    return std::to_string(value);
  }
}

/// "corners, gradient or random"
template <SettingChoice Choice>
std::string choice_text() {
  std::string text;
  const auto all = choices(Choice());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) text += i + 1 == all.size() ? " or " : ", ";
    text += all[i].second;
  }
  return text;
}

}  // namespace ldso
