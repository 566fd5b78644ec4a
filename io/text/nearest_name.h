#pragma once

#include <string>
#include <vector>

namespace ldso {

/// The name that takes the fewest insertions, deletions and substitutions to become `name` (Levenshtein distance), for
/// "did you mean"; empty if `names` is.
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace ldso
