#pragma once
// What the program is made of, for `--version` and run.json.

#include <nlohmann/json.hpp>
#include <string>

namespace ldso {

std::string project_version();
std::string compiler_version();

/// Project, build type, compiler and the libraries with their versions.
nlohmann::ordered_json versions_json();

}  // namespace ldso
