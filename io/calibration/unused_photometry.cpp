#include "io/calibration/unused_photometry.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <system_error>

#include "io/text/text_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

bool has_any(const std::string& name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

/// Files of the folder, in order, so that a run says the same every time.
std::vector<std::string> file_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.is_regular_file(ignored)) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

void warn_about_unused_photometry(const fs::path& folder, const PhotometricCalibration& photometric,
                                  std::vector<std::string>& warnings) {
  for (const std::string& name : file_names(folder)) {
    const std::string lower = to_lower(name);
    const bool vignette = photometric.vignette.empty() && has_any(lower, {"vignette", "vignetting"});
    const bool response = !photometric.inverse_response && has_any(lower, {"pcalib", "response", "photocalib"});
    if (!vignette && !response) continue;
    warnings.push_back((folder / name).string() + ": this " + (vignette ? "vignette" : "response") +
                       " is not used: beside images, " + (vignette ? "vignette.png" : "pcalib.txt") +
                       " is what is looked for");
  }
}

}  // namespace ldso
