#include "results/versions.h"

#include <CLI/Version.hpp>
#include <Eigen/Core>

namespace ldso {
namespace {

std::string dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace

std::string project_version() { return LDSO_VERSION; }

std::string compiler_version() {
#if defined(__clang__)
  return std::string("Clang ") + __clang_version__;
#elif defined(__GNUC__)
  return std::string("GCC ") + __VERSION__;
#else
  return "unknown";
#endif
}

nlohmann::ordered_json versions_json() {
  nlohmann::ordered_json libraries = {
      {"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Ceres", LDSO_CERES_VERSION},
      {"OpenCV", LDSO_OPENCV_VERSION},
      {"Highway", LDSO_HIGHWAY_VERSION},
      {"yaml-cpp", LDSO_YAML_CPP_VERSION},
      {"libzip", LDSO_LIBZIP_VERSION},
      {"nlohmann_json", dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"CLI11", CLI11_VERSION},
  };
  return {{"ldso", project_version()},
          {"build_type", LDSO_BUILD_TYPE},
          {"compiler", compiler_version()},
          {"libraries", std::move(libraries)}};
}

}  // namespace ldso
