#pragma once

// The values that a setting may take: Settings::validate() holds every field to its range.

#include <optional>
#include <string_view>

namespace ldso {

struct SettingRange {
  double least = 0;
  double largest = 0;
};

/// Of a number by its dotted key ("window.iterations"); nothing for switches, choices and unknown keys.
std::optional<SettingRange> setting_range(std::string_view key);

}  // namespace ldso
