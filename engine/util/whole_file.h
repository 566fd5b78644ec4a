#pragma once

// Files that are read and written as a whole.

#include <filesystem>
#include <string>
#include <string_view>

namespace ldso {

/// Whole content of a file. Throws Error if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Writes `content` beside `path` first and renames it, so that an interrupted run never leaves half a file.
/// Throws Error if it cannot be written completely.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace ldso
