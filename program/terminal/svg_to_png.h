#pragma once
// SVG to PNG by the program rsvg-convert (Debian package librsvg2-bin), if the machine has it.

#include <filesystem>

namespace ldso {

inline constexpr const char* kPngProgram = "rsvg-convert";

/// Whether the program can be started.
bool can_make_png();

/// False if the program failed; its complaints go to stderr. May be called from several threads.
bool make_png(const std::filesystem::path& svg, const std::filesystem::path& png);

}  // namespace ldso
