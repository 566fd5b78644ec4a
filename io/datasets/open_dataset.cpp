#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "io/datasets/euroc_dataset.h"
#include "io/datasets/image_folder_dataset.h"
#include "io/datasets/kitti_dataset.h"
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
constexpr std::array<Format, 6> kFormats{{
    {"EuRoC: mav0/cam0/data.csv", is_euroc, open_euroc},
    {"TUM RGB-D: rgb.txt", is_tum_rgbd, open_tum_rgbd},
    {"KITTI: image_0/ or image_2/", is_kitti, open_kitti},
    {"TUM-mono: images/ or images.zip", is_tum_mono, open_tum_mono},
    {"image folder: images and camera.txt", is_image_folder, open_image_folder_dataset},
    {"video: a file *.mp4, *.avi, *.mov, *.mkv, ...", is_video, open_video},
}};

std::string looked_for() {
  std::string text = "looked for";
  for (const Format& format : kFormats)
    text += std::string(&format == kFormats.begin() ? " " : "; ") + format.looked_for;
  return text;
}

std::unique_ptr<Dataset> open_whole(const fs::path& path, const DatasetOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(path.string(), "there is no such file or folder", "check the path");
  if (fs::is_directory(path, error) && fs::is_empty(path, error))
    throw Error(path.string(), "the folder is empty", looked_for());
  for (const Format& format : kFormats) {
    if (format.recognizes(path)) return format.open(path, options);
  }
  throw Error(path.string(), "is no image sequence of a known format", looked_for());
}

}  // namespace

std::unique_ptr<Dataset> open_dataset(const fs::path& path, const DatasetOptions& options) {
  return make_playback_dataset(open_whole(path, options), options);
}

}  // namespace ldso
