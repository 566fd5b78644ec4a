#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace ldso {

/// Where the encoded images of a sequence lie: a folder or an archive.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  ImageSource(const ImageSource&) = delete;
  ImageSource& operator=(const ImageSource&) = delete;

  /// The images in it, in the order of sort_image_names().
  virtual std::vector<std::string> names() const = 0;
  /// Bytes of the encoded image. Throws Error naming it.
  virtual std::vector<std::uint8_t> read(const std::string& name) const = 0;
  /// What messages call the image.
  virtual std::string describe(const std::string& name) const = 0;

 protected:
  ImageSource() = default;
};

/// Throws Error if there is no such folder.
std::unique_ptr<ImageSource> open_image_folder(const std::filesystem::path& folder);

/// Images may lie in folders inside the archive. Throws Error if it is not a zip archive.
std::unique_ptr<ImageSource> open_image_zip(const std::filesystem::path& archive);

}  // namespace ldso
