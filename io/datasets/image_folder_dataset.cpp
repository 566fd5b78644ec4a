#include "io/datasets/image_folder_dataset.h"

#include <system_error>
#include <utility>
#include <vector>

#include "io/calibration/foreign_calibration.h"
#include "io/calibration/unused_photometry.h"
#include "io/datasets/sequence_dataset.h"
#include "io/images/image_names.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultFps = 30.0;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

Calibration read_calibration(const fs::path& folder, const DatasetOptions& options) {
  Calibration calibration;
  if (options.uncalibrated) {
    calibration.source = CameraSource::kNone;
    return calibration;
  }
  const fs::path camera = options.calibration_file.value_or(find_calibration(folder));
  if (options.calibration_file || is_there(camera)) {
    calibration = read_camera_calibration(camera);
  } else {
    calibration.source = CameraSource::kNone;  // Which one is known once an image has been seen.
  }
  read_photometric_calibration(folder, calibration);
  return calibration;
}

std::vector<FrameEntry> read_frames(const fs::path& folder, const std::vector<std::string>& names,
                                    const DatasetOptions& options, std::vector<std::string>& warnings) {
  const fs::path times = folder / "times.txt";
  if (is_there(times)) return match_times(names, read_tum_mono_times(times, warnings), warnings);
  if (!options.fps) {
    warnings.push_back(folder.string() + ": there is no times.txt; 30 frames a second are assumed (--fps changes it)");
  }
  return times_from_rate(names, options.fps.value_or(kDefaultFps));
}

}  // namespace

bool is_image_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && !open_image_folder(folder)->names().empty();
}

std::unique_ptr<Dataset> open_image_folder_dataset(const fs::path& folder, const DatasetOptions& options) {
  return open_images_with_text_files("image folder", folder, open_image_folder(folder), options);
}

std::unique_ptr<Dataset> open_images_with_text_files(const std::string& format_name, const fs::path& folder,
                                                     std::unique_ptr<ImageSource> images,
                                                     const DatasetOptions& options) {
  Sequence sequence;
  sequence.format_name = format_name;
  sequence.location = folder.string();
  const std::vector<std::string> names = choose_images(images->names(), options.pattern, images->describe(""));
  if (names.empty()) {
    throw Error(images->describe(""), "there are no images", "PNG, JPEG, PGM, TIFF and BMP images are looked for");
  }
  sequence.images = std::move(images);
  sequence.calibration = read_calibration(folder, options);
  warn_about_unused_photometry(folder, sequence.calibration.photometric, sequence.warnings);
  sequence.frames = read_frames(folder, names, options, sequence.warnings);
  for (const char* name : {"groundtruth.txt", "groundtruthSync.txt"}) {
    const fs::path file = folder / name;
    if (sequence.ground_truth || !is_there(file)) continue;
    read_ground_truth(sequence, [&] { return read_tum_trajectory(file); });
  }
  return make_sequence_dataset(std::move(sequence));
}

}  // namespace ldso
