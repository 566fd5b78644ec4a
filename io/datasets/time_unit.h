#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ldso {

// Files of times seldom say their unit. Cameras take between 0.2 and 200 images a second, so that the gap from one
// image to the next tells seconds, milliseconds, microseconds and nanoseconds apart.

/// Seconds in the unit of `times` (1, 1e-3, 1e-6 or 1e-9) by the median of the gaps; 1 for less than two times.
double seconds_per_unit(const std::vector<double>& times);

/// Whether times are whole numbers, most of them one more than the one before: rather numbers of frames than seconds.
bool look_like_frame_numbers(const std::vector<double>& times);

/// Converts times of the file `path` to seconds and says so if they were not, or if they look like frame numbers.
void convert_to_seconds(std::vector<double>& times, const std::filesystem::path& path,
                        std::vector<std::string>& warnings);

}  // namespace ldso
