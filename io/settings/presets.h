#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ldso/settings.h"

namespace ldso {

// Several settings under one name, as the value of the key `preset`. What is set after it holds in its stead; in a file
// the preset counts first.

/// Changes what the preset is about. Throws Error naming the presets if there is none of that name; `where` is what the
/// complaint begins with.
void apply_preset(const std::string& where, const std::string& name, Settings& settings);

struct Preset {
  std::string_view name, help;
  std::vector<std::pair<std::string, std::string>> settings;
};

std::span<const Preset> presets();

}  // namespace ldso
