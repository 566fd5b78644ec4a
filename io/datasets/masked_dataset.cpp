#include "io/datasets/masked_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/images/dark_border.h"
#include "io/images/image_file.h"
#include "io/images/image_source.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

using Mask = Image<std::uint8_t>;

/// From here on a pixel of a mask is white.
constexpr float kWhite = 128;

/// Frames by which a border is told from dark parts of the scene.
constexpr int kBorderFrames = 16;

/// An image of which most is dark says nothing of its border: a film may begin in black.
constexpr float kDarkScene = 16;
constexpr double kMostDark = 0.9;

std::string mask_size(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

Mask mask_of(const Image<float>& grey, const std::string& name, const CameraCalibration& camera) {
  if (grey.width() != camera.width || grey.height() != camera.height) {
    throw Error(name,
                "the mask is " + mask_size(grey.width(), grey.height()) + ", but the images are " +
                    mask_size(camera.width, camera.height),
                "give a mask of the images' size");
  }
  Mask mask(grey.width(), grey.height());
  std::transform(grey.data(), grey.data() + grey.size(), mask.data(),
                 [](float value) { return static_cast<std::uint8_t>(value >= kWhite ? 255 : 0); });
  return mask;
}

void add_mask(const Mask& more, Mask& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i) mask.data()[i] |= more.data()[i];
}

/// Grey levels below zero are not used.
void apply(const Mask& mask, Image<float>& grey) {
  if (mask.width() != grey.width() || mask.height() != grey.height()) return;  // The run refuses such a frame.
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask.data()[i] != 0) grey.data()[i] = -1;
  }
}

/// Masks of a folder, by the stem of their names, and in their order.
class MaskFolder {
 public:
  explicit MaskFolder(const fs::path& folder)
      : folder_(folder), source_(open_image_folder(folder)), names_(source_->names()) {
    if (names_.empty()) throw Error(folder.string(), "there is no mask in it", "give images, white where masked");
    for (const std::string& name : names_) by_stem_[fs::path(name).stem().string()] = name;
  }

  /// Decides whether masks belong to frames by name or by order.
  void match(const std::vector<std::string>& frames, std::vector<std::string>& warnings) {
    missing_ = std::count_if(frames.begin(), frames.end(), [&](const std::string& f) { return !named(f); });
    by_order_ = missing_ == static_cast<std::ptrdiff_t>(frames.size());
    if (by_order_ && names_.size() != frames.size()) {
      throw Error(folder_.string(),
                  "holds " + std::to_string(names_.size()) + " masks, none of which has the name of one of the " +
                      std::to_string(frames.size()) + " images",
                  "name each mask as its image");
    }
    if (!by_order_ && missing_ > 0)
      warnings.push_back(folder_.string() + ": " + std::to_string(missing_) + " of " + std::to_string(frames.size()) +
                         " images have no mask there and are used as they are");
  }

  /// Name of a frame's mask; null if it has none.
  const std::string* find(int index, const std::string& frame) const {
    return by_order_ ? &names_[static_cast<std::size_t>(index)] : named(frame);
  }

  Mask read(const std::string& name, const CameraCalibration& camera) const {
    const std::string described = source_->describe(name);
    return mask_of(decode_grey_image(source_->read(name), described), described, camera);
  }

 private:
  const std::string* named(const std::string& frame) const {
    const auto found = by_stem_.find(fs::path(frame).stem().string());
    return found == by_stem_.end() ? nullptr : &found->second;
  }

  fs::path folder_;
  std::unique_ptr<ImageSource> source_;
  std::vector<std::string> names_;
  std::map<std::string, std::string> by_stem_;
  std::ptrdiff_t missing_ = 0;
  bool by_order_ = false;
};

bool is_dark(const Image<float>& grey) {
  const auto dark = std::count_if(grey.data(), grey.data() + grey.size(), [](float v) { return v <= kDarkScene; });
  return static_cast<double>(dark) > kMostDark * static_cast<double>(grey.size());
}

/// Frame `index`, if it can be read and has the right size.
std::optional<Image<float>> readable(const Dataset& dataset, int index) {
  try {
    RawFrame frame = dataset.read(index);
    const CameraCalibration& camera = dataset.calibration().camera;
    if (frame.grey.width() == camera.width && frame.grey.height() == camera.height) return std::move(frame.grey);
  } catch (const Error&) {
    // The run says so when it comes to it.
  }
  return std::nullopt;
}

/// The border of all frames. What one frame shows no border in has none: most sequences cost one frame.
DarkBorder border_of(const Dataset& dataset) {
  const int step = std::max(1, dataset.size() / kBorderFrames);
  Image<float> brightest;
  DarkBorder border;
  for (int index = 0; index < dataset.size(); index += step) {
    const std::optional<Image<float>> grey = readable(dataset, index);
    if (!grey || is_dark(*grey)) continue;
    if (brightest.empty()) brightest = Image<float>(grey->width(), grey->height(), 0.F);
    std::transform(grey->data(), grey->data() + grey->size(), brightest.data(), brightest.data(),
                   [](float a, float b) { return std::max(a, b); });
    border = find_dark_border(brightest.view());
    if (border.kind == DarkBorderKind::kNone) return {};
  }
  return border;
}

class MaskedDataset final : public Dataset {
 public:
  explicit MaskedDataset(std::unique_ptr<Dataset> sequence)
      : sequence_(std::move(sequence)), warnings_(sequence_->warnings()) {}

  void mask_border() {
    const DarkBorder border = border_of(*sequence_);
    if (border.kind == DarkBorderKind::kNone) return;
    const std::string what = border.kind == DarkBorderKind::kRound ? "the image is round" : "the image has black bars";
    warnings_.push_back(what + ": " + std::to_string(std::lround(100 * border.share)) +
                        " % of its pixels are not used (--mask none uses them)");
    add(border.mask);
  }

  void mask_by(const fs::path& path) {
    if (fs::is_directory(path)) {
      folder_.emplace(path);
      folder_->match(frame_names(), warnings_);
      if (const std::string* first = folder_->find(0, frame_names().front())) folder_->read(*first, camera());
    } else {
      add(mask_of(read_grey_image(path), path.string(), camera()));
    }
  }

  int size() const override { return sequence_->size(); }
  double timestamp(int index) const override { return sequence_->timestamp(index); }
  const Calibration& calibration() const override { return sequence_->calibration(); }
  std::optional<Trajectory> ground_truth() const override { return sequence_->ground_truth(); }
  std::string format_name() const override { return sequence_->format_name(); }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::string frame_name(int index) const override { return sequence_->frame_name(index); }

  RawFrame read(int index) const override {
    RawFrame frame = sequence_->read(index);
    if (!common_.empty()) apply(common_, frame.grey);
    const std::string* name = folder_ ? folder_->find(index, frame_name(index)) : nullptr;
    if (name != nullptr) apply(folder_->read(*name, camera()), frame.grey);
    return frame;
  }

  Image<Rgb> read_color(int index) const override { return sequence_->read_color(index); }

 private:
  const CameraCalibration& camera() const { return calibration().camera; }

  std::vector<std::string> frame_names() const {
    std::vector<std::string> names;
    for (int i = 0; i < size(); ++i) names.push_back(frame_name(i));
    return names;
  }

  void add(Mask mask) {
    if (!common_.empty()) add_mask(common_, mask);
    common_ = std::move(mask);
  }

  std::unique_ptr<Dataset> sequence_;
  std::vector<std::string> warnings_;
  Mask common_;  ///< Of all frames; empty: none.
  std::optional<MaskFolder> folder_;
};

}  // namespace

std::unique_ptr<Dataset> make_masked_dataset(std::unique_ptr<Dataset> sequence, const std::optional<fs::path>& mask) {
  if (mask && *mask == kNoMask) return sequence;
  auto masked = std::make_unique<MaskedDataset>(std::move(sequence));
  masked->mask_border();
  if (mask) masked->mask_by(*mask);
  return masked;
}

}  // namespace ldso
