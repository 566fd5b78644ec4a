#pragma once
// loops.json: every pair of keyframes that looked like the same place, and what became of it.

#include <nlohmann/json.hpp>
#include <vector>

#include "ldso/records.h"

namespace ldso {

/// Format: docs/loops.md.
nlohmann::ordered_json loops_json(const std::vector<LoopRecord>& loops);

}  // namespace ldso
