#include "io/datasets/tum_mono_dataset.h"

#include <system_error>

#include "io/datasets/image_folder_dataset.h"
#include "io/images/image_source.h"

namespace ldso {

namespace fs = std::filesystem;

bool is_tum_mono(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "images", error) || fs::is_regular_file(folder / "images.zip", error);
}

std::unique_ptr<Dataset> open_tum_mono(const fs::path& folder, const DatasetOptions& options) {
  std::error_code error;
  auto images = fs::is_directory(folder / "images", error) ? open_image_folder(folder / "images")
                                                           : open_image_zip(folder / "images.zip");
  return open_images_with_text_files("TUM-mono", folder, std::move(images), options);
}

}  // namespace ldso
