#pragma once
// Images from whatever a user has: sequences of any known format, folders of images, single image files.

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "image/frame.h"
#include "image/frame_preprocessor.h"
#include "ldso/io/dataset.h"

namespace ldso {

class TrainingImages {
 public:
  /// Uses every stride-th image of each path. Throws Error naming the path that holds no images.
  TrainingImages(const std::vector<std::filesystem::path>& paths, int stride);

  int size() const { return static_cast<int>(entries_.size()); }
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// As the odometry would see it: of sequences rectified and with response and vignette undone, others as they are.
  /// From any thread. Throws Error naming the image if it cannot be read.
  ImagePyramid read(int index) const;

 private:
  struct Sequence {
    std::unique_ptr<Dataset> dataset;
    FramePreprocessor preprocessor;
    mutable std::mutex mutex;  ///< A dataset reads for one thread at a time.
  };
  struct Entry {
    const Sequence* sequence = nullptr;  ///< None: an image file.
    int frame = 0;
    std::filesystem::path file;
  };

  void add_sequence(const std::filesystem::path& path, int stride);
  void add_folder(const std::filesystem::path& folder, int stride);

  std::vector<std::unique_ptr<Sequence>> sequences_;
  std::vector<Entry> entries_;
  std::vector<std::string> warnings_;
};

}  // namespace ldso
