#include "ldso/settings.h"

#include <string>
#include <type_traits>

#include "ldso/error.h"
#include "settings/setting_range.h"

namespace ldso {

void Settings::validate() const {
  for_each_setting(*this, [](const std::string& key, const auto& value, const SettingInfo& info) {
    if constexpr (SettingNumber<std::remove_cvref_t<decltype(value)>>) {
      check_range("setting " + key, static_cast<double>(value), info);
    }
  });
  if (keyframes.window_min > keyframes.window_max) {
    throw Error("setting keyframes.window_min", std::to_string(keyframes.window_min) + " is out of range",
                "allowed is at most keyframes.window_max, " + std::to_string(keyframes.window_max));
  }
}

}  // namespace ldso
