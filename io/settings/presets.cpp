#include "io/settings/presets.h"

#include <algorithm>

#include "ldso/error.h"
#include "ldso/io/settings_file.h"

namespace ldso {

std::span<const Preset> presets() {
  static const std::vector<Preset> kPresets{
      {"default", "As it is without a preset.", {}},
      {"fast",
       "Smaller images, fewer points, a shorter window: several times as fast for somewhat less accuracy.",
       {{"longest_side", "424"},
        {"selection.candidates", "800"},
        {"window.active_points", "800"},
        {"window.iterations", "4"},
        {"keyframes.window_min", "4"},
        {"keyframes.window_max", "6"}}},
  };
  return kPresets;
}

void apply_preset(const std::string& where, const std::string& name, Settings& settings) {
  const auto all = presets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Preset& preset) { return preset.name == name; });
  if (found == all.end()) {
    std::string names;
    for (const Preset& preset : all) names += (names.empty() ? "" : ", ") + std::string(preset.name);
    throw Error(where, "there is no preset '" + name + "'", "there are: " + names);
  }
  for (const auto& [key, value] : found->settings) set_setting(settings, key, value);
}

}  // namespace ldso
