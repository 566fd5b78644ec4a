#pragma once

#include <filesystem>
#include <optional>

namespace ldso {

/// A file that may hold several cameras, and which of them is wanted.
struct CameraChoice {
  std::filesystem::path file;
  std::optional<int> camera = std::nullopt;  ///< Counted from 0; nothing: whichever there is.
};

/// "camchain.yaml:cam1" or "camchain.yaml:1" are the second camera of camchain.yaml, unless there is a file of just
/// that name.
CameraChoice choose_camera(const std::filesystem::path& path);

}  // namespace ldso
