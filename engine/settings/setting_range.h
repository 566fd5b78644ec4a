#pragma once

// The values that a setting may take, checked and in words.

#include <string>

#include "ldso/setting.h"

namespace ldso {

/// A number without digits that say nothing: "0.05", "1e+06".
std::string number_text(double value);

/// "1 to 100 px", "at least 0"; for numbers.
std::string allowed_text(const SettingInfo& info);

/// Throws Error, whose message begins with `where`, if the value is not in the range or no number.
void check_range(const std::string& where, double value, const SettingInfo& info);

}  // namespace ldso
