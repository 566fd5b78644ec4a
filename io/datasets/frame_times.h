#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ldso {

// Which frame was taken when, and how long it was exposed.

/// A frame of a sequence before it is decoded.
struct FrameEntry {
  std::string name;                   ///< Of the image in its ImageSource.
  double timestamp = 0;               ///< [s]
  std::optional<double> exposure_ms;  ///< Positive and finite where known.
};

/// A line of a times file.
struct FrameTime {
  std::string id;
  double timestamp = 0;
  std::optional<double> exposure_ms;
};

struct FrameTimes {
  std::filesystem::path path;
  std::vector<FrameTime> entries;
  bool ids_are_written = false;  ///< The file carries ids; otherwise they are the line numbers, counted from 0.
};

/// `id timestamp [exposure_ms]` a line. An exposure that is NaN, infinite, zero or negative is unknown; one warning
/// counts them. Times in milliseconds, microseconds or nanoseconds are converted, with a warning. Throws Error naming
/// file and line if a line is not of this form.
FrameTimes read_tum_mono_times(const std::filesystem::path& path, std::vector<std::string>& warnings);

/// A timestamp a line, converted to seconds as above.
FrameTimes read_kitti_times(const std::filesystem::path& path, std::vector<std::string>& warnings);

/// Joins images and times, by the ids that the image names carry (equal names or equal numbers) or else by order.
/// If both are counted without a gap, but from different numbers (images from 1, ids from 0), the order counts where
/// there are as many; where not, what belongs together cannot be told, which is an Error. If they differ in number,
/// those with equal ids are used and a warning counts the rest; without common ids: Error.
std::vector<FrameEntry> match_times(const std::vector<std::string>& names, const FrameTimes& times,
                                    std::vector<std::string>& warnings);

/// Frame i at i / fps [s].
std::vector<FrameEntry> times_from_rate(const std::vector<std::string>& names, double fps);

}  // namespace ldso
