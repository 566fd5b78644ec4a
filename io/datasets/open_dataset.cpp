#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "io/datasets/bag_dataset.h"
#include "io/datasets/euroc_dataset.h"
#include "io/datasets/image_folder_dataset.h"
#include "io/datasets/kitti_dataset.h"
#include "io/datasets/masked_dataset.h"
#include "io/datasets/playback_dataset.h"
#include "io/datasets/tum_mono_dataset.h"
#include "io/datasets/tum_rgbd_dataset.h"
#include "io/datasets/video_dataset.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* looked_for;
  bool (*recognizes)(const fs::path&);
  std::unique_ptr<Dataset> (*open)(const fs::path&, const DatasetOptions&);
};

/// In the order in which they are tried: what is most particular comes first.
constexpr std::array<Format, 7> kFormats{{
    {"ROS bag: a file *.bag, *.mcap or *.db3, or a folder with its metadata.yaml", is_bag, open_bag_dataset},
    {"EuRoC: mav0/cam0/data.csv", is_euroc, open_euroc},
    {"TUM RGB-D: rgb.txt", is_tum_rgbd, open_tum_rgbd},
    {"KITTI: image_0/ or image_2/", is_kitti, open_kitti},
    {"TUM-mono: images/ or images.zip", is_tum_mono, open_tum_mono},
    {"image folder: images and camera.txt", is_image_folder, open_image_folder_dataset},
    {"video: a file *.mp4, *.avi, *.mov, *.mkv, ...", is_video, open_video},
}};

/// Folders in folders that are looked into for a sequence, and files and folders in all.
constexpr int kMostDepth = 2;
constexpr int kMostEntries = 20'000;

/// Sequences that a message names.
constexpr std::size_t kMostNamed = 4;

std::string looked_for() {
  std::string text = "looked for";
  for (const Format& format : kFormats)
    text += std::string(&format == kFormats.begin() ? " " : "; ") + format.looked_for;
  return text;
}

/// Whether a folder or file is one of the formats, bags and videos by their names alone.
bool looks_like_sequence(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return has_bag_extension(path) || has_video_extension(path);
  return std::any_of(kFormats.begin(), kFormats.end(), [&](const Format& format) { return format.recognizes(path); });
}

/// Sequences in `folder` and the folders in it: people give the folder of a whole recording.
std::vector<std::string> find_sequences(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  for (int seen = 0; !error && entry != fs::recursive_directory_iterator() && seen < kMostEntries; ++seen) {
    if (entry.depth() >= kMostDepth) entry.disable_recursion_pending();
    if (looks_like_sequence(entry->path())) {
      found.push_back(entry->path().lexically_relative(folder).string());
      entry.disable_recursion_pending();
    }
    entry.increment(error);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// What to give instead of a folder that is no sequence.
std::string remedy_for(const fs::path& folder) {
  const std::vector<std::string> found = find_sequences(folder);
  if (found.empty()) return looked_for();
  std::string names;
  for (std::size_t i = 0; i < std::min(found.size(), kMostNamed); ++i) names += (i > 0 ? ", " : "") + found[i];
  if (found.size() > kMostNamed) names += ", ...";
  return "there are images, videos or bags in " + names +
         ": give one of these, with the camera's calibration by --calib if it lies elsewhere, and --fps";
}

std::unique_ptr<Dataset> open_whole(const fs::path& path, const DatasetOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(path.string(), "there is no such file or folder", "check the path");
  if (fs::is_directory(path, error) && fs::is_empty(path, error))
    throw Error(path.string(), "the folder is empty", looked_for());
  if (!options.topic.empty() && !is_bag(path))
    throw Error(path.string(), "is no ROS bag, but --topic is given", "leave --topic away");
  for (const Format& format : kFormats) {
    if (format.recognizes(path)) return format.open(path, options);
  }
  throw Error(path.string(), "is no image sequence of a known format", remedy_for(path));
}

}  // namespace

std::unique_ptr<Dataset> open_dataset(const fs::path& path, const DatasetOptions& options) {
  return make_playback_dataset(make_masked_dataset(open_whole(path, options), options.mask), options);
}

}  // namespace ldso
