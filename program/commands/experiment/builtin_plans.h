#pragma once
// The plans of experiments/plans/ as parts of the program, so that an installed one knows them by name.

#include <string>
#include <utility>
#include <vector>

namespace ldso {

/// (name, YAML text), e.g. ("kitti", ..).
const std::vector<std::pair<std::string, std::string>>& builtin_plans();

}  // namespace ldso
