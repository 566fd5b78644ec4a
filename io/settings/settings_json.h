#pragma once

#include <nlohmann/json.hpp>

#include "ldso/settings.h"

namespace ldso {

/// All settings as nested objects, by the names of settings_file.h.
nlohmann::json settings_to_json(const Settings& settings);

}  // namespace ldso
