#include "commands/training_images.h"

#include <system_error>

#include "image/pyramid.h"
#include "io/datasets/image_folder_dataset.h"
#include "io/images/image_file.h"
#include "io/images/image_source.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

TrainingImages::TrainingImages(const std::vector<fs::path>& paths, int stride) {
  for (const fs::path& path : paths) {
    if (is_file(path) && has_image_extension(path)) {
      entries_.push_back({nullptr, 0, path});
    } else if (is_image_folder(path) && !is_file(path / "camera.txt")) {
      add_folder(path, stride);
    } else {
      add_sequence(path, stride);
    }
  }
}

void TrainingImages::add_folder(const fs::path& folder, int stride) {
  const std::vector<std::string> names = open_image_folder(folder)->names();
  for (std::size_t i = 0; i < names.size(); i += static_cast<std::size_t>(stride))
    entries_.push_back({nullptr, 0, folder / names[i]});
}

void TrainingImages::add_sequence(const fs::path& path, int stride) {
  DatasetOptions options;
  options.stride = stride;
  std::unique_ptr<Dataset> dataset = open_dataset(path, options);
  warnings_.insert(warnings_.end(), dataset->warnings().begin(), dataset->warnings().end());
  FramePreprocessor preprocessor(dataset->calibration(), {});
  const int count = dataset->size();
  // Not make_unique, which Clang before 16 cannot do with aggregates.
  sequences_.push_back(std::unique_ptr<Sequence>(new Sequence{std::move(dataset), std::move(preprocessor), {}}));
  for (int i = 0; i < count; ++i) entries_.push_back({sequences_.back().get(), i, {}});
}

ImagePyramid TrainingImages::read(int index) const {
  const Entry& entry = entries_[static_cast<std::size_t>(index)];
  if (entry.sequence == nullptr) {
    const Image<float> grey = read_grey_image(entry.file);
    return build_pyramid(grey.view());
  }
  const RawFrame raw = [&] {
    const std::lock_guard lock(entry.sequence->mutex);
    return entry.sequence->dataset->read(entry.frame);
  }();
  return entry.sequence->preprocessor.process(raw).pyramid;
}

}  // namespace ldso
