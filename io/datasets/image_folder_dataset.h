#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/images/image_source.h"
#include "ldso/io/dataset.h"

namespace ldso {

// A folder of images, with `camera.txt` in it or given. `times.txt`, `pcalib.txt`, `vignette.png` and `groundtruth.txt`
// are used if they lie there too; without times.txt the frame rate gives the times.

bool is_image_folder(const std::filesystem::path& folder);

/// Opens it; only the options calibration_file, fps and pattern are used. Throws Error.
std::unique_ptr<Dataset> open_image_folder_dataset(const std::filesystem::path& folder, const DatasetOptions& options);

/// Images of any source with the files named above in `folder`: shared with the TUM-mono format.
std::unique_ptr<Dataset> open_images_with_text_files(const std::string& format_name,
                                                     const std::filesystem::path& folder,
                                                     std::unique_ptr<ImageSource> images,
                                                     const DatasetOptions& options);

}  // namespace ldso
