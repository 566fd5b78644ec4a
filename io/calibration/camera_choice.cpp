#include "io/calibration/camera_choice.h"

#include <string>
#include <system_error>

namespace ldso {
namespace {

/// Files hold a few cameras.
constexpr std::size_t kMostDigits = 3;

}  // namespace

CameraChoice choose_camera(const std::filesystem::path& path) {
  const std::string text = path.string();
  const std::size_t colon = text.rfind(':');
  std::error_code error;
  if (colon == std::string::npos || std::filesystem::exists(path, error)) return {path};
  const std::string behind = text.substr(colon + 1);
  const std::string number = behind.substr(behind.starts_with("cam") ? 3 : 0);
  if (number.empty() || number.size() > kMostDigits || number.find_first_not_of("0123456789") != std::string::npos)
    return {path};
  return {text.substr(0, colon), std::stoi(number)};
}

}  // namespace ldso
