#pragma once

// A recorded run as a file: the messages that a page would have got at its end.

#include <filesystem>

#include "viewer/map/live_map.h"

namespace ldso {

/// Its name in the folder of a run.
inline constexpr const char* kRecordingName = "recording.ldso";

/// All messages but the hello, whose mode becomes `kReplay`. Throws Error if the file cannot be read, is damaged or of
/// another version.
void read_recording(const std::filesystem::path& path, LiveMap& map);

/// Throws Error if it cannot be written.
void write_recording(const std::filesystem::path& path, const Bytes& recording);

}  // namespace ldso
