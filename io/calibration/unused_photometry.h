#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ldso/calibration.h"

namespace ldso {

/// Warns of files in `folder` that seem to hold a response or a vignette, but not under the names that are looked for,
/// if `photometric` lacks what they seem to hold.
void warn_about_unused_photometry(const std::filesystem::path& folder, const PhotometricCalibration& photometric,
                                  std::vector<std::string>& warnings);

}  // namespace ldso
