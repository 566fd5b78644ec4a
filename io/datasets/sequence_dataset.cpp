#include "io/datasets/sequence_dataset.h"

#include <array>
#include <utility>

#include "io/calibration/calibration_doubts.h"
#include "io/calibration/guessed_calibration.h"
#include "io/datasets/sequence_images.h"
#include "io/images/exif.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

struct ImageSize {
  int width = 0;
  int height = 0;
  std::string name;
};

std::string to_string(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

Image<float> decode(const Sequence& sequence, int index) {
  const std::string& name = sequence.frames[static_cast<std::size_t>(index)].name;
  return decode_grey_image(sequence.images->read(name), sequence.images->describe(name), sequence.bits);
}

/// Size of the first readable image among some spread over the sequence that has the wanted size; if none has, of the
/// first readable one. Throws what the first image throws if none of them is readable.
ImageSize representative_size(const Sequence& sequence, int wanted_width, int wanted_height) {
  const int count = static_cast<int>(sequence.frames.size());
  const std::array<int, 5> samples{0, count / 4, count / 2, 3 * count / 4, count - 1};
  std::optional<ImageSize> first;
  std::string problem;
  for (const int index : samples) {
    try {
      const Image<float> image = decode(sequence, index);
      ImageSize size{image.width(), image.height(), sequence.images->describe(sequence.frames[index].name)};
      if (image.width() == wanted_width && image.height() == wanted_height) return size;
      if (!first) first = std::move(size);
      if (wanted_width == 0) return *first;
    } catch (const Error& error) {
      if (problem.empty()) problem = error.what();
    }
  }
  if (!first) throw Error(sequence.location, "none of several images tried can be read", problem);
  return *first;
}

/// Of a camera that nobody calibrated. What is known of its photometry stays.
void guess_camera(Sequence& sequence, const ImageSize& size) {
  const std::vector<std::uint8_t> bytes = sequence.images->read(sequence.frames.front().name);
  Calibration guess = guess_calibration(size.width, size.height, exif_focal_35mm(bytes));
  guess.photometric = std::move(sequence.calibration.photometric);
  sequence.calibration = std::move(guess);
}

void fit_calibration_to_images(Sequence& sequence) {
  CameraCalibration& camera = sequence.calibration.camera;
  const ImageSize size = representative_size(sequence, camera.width, camera.height);
  if (sequence.calibration.is_guess()) {
    guess_camera(sequence, size);
  } else if (camera.width == 0 && camera.height == 0) {
    camera.width = size.width;
    camera.height = size.height;
    doubt_intrinsics(camera, sequence.calibration.description, sequence.calibration.warnings);
  }
  if (size.width != camera.width || size.height != camera.height) {
    throw Error(size.name,
                "the image is " + to_string(size.width, size.height) + ", but the calibration (" +
                    sequence.calibration.description + ") is for " + to_string(camera.width, camera.height),
                "give a calibration of this camera at this image size");
  }
  const Image<float>& vignette = sequence.calibration.photometric.vignette;
  if (!vignette.empty() && (vignette.width() != camera.width || vignette.height() != camera.height)) {
    throw Error(sequence.location,
                "the vignette is " + to_string(vignette.width(), vignette.height()) + ", but the images are " +
                    to_string(camera.width, camera.height),
                "give a vignette of the images' size or remove it");
  }
}

void warn_about_time_order(Sequence& sequence) {
  int count = 0;
  std::string first;
  for (std::size_t i = 1; i < sequence.frames.size(); ++i) {
    if (sequence.frames[i].timestamp > sequence.frames[i - 1].timestamp) continue;
    if (count++ == 0) first = sequence.frames[i].name;
  }
  if (count == 0) return;
  sequence.warnings.push_back(sequence.location + ": " + std::to_string(count) +
                              " timestamps are not later than the one before, first that of " + first);
}

class SequenceDataset final : public Dataset {
 public:
  explicit SequenceDataset(Sequence sequence) : sequence_(std::move(sequence)) {}

  int size() const override { return static_cast<int>(sequence_.frames.size()); }
  double timestamp(int index) const override { return entry(index).timestamp; }
  std::string frame_name(int index) const override { return entry(index).name; }
  const Calibration& calibration() const override { return sequence_.calibration; }
  std::optional<Trajectory> ground_truth() const override { return sequence_.ground_truth; }
  std::string format_name() const override { return sequence_.format_name; }
  const std::vector<std::string>& warnings() const override { return sequence_.warnings; }

  RawFrame read(int index) const override {
    const FrameEntry& frame = entry(index);
    RawFrame raw;
    raw.id = index;
    raw.timestamp = frame.timestamp;
    raw.exposure_ms = frame.exposure_ms;
    raw.name = sequence_.images->describe(frame.name);
    raw.grey = decode(sequence_, index);
    return raw;
  }

  Image<Rgb> read_color(int index) const override {
    const std::string& name = entry(index).name;
    return decode_color_image(sequence_.images->read(name), sequence_.images->describe(name), sequence_.bits);
  }

 private:
  const FrameEntry& entry(int index) const { return sequence_.frames.at(static_cast<std::size_t>(index)); }

  Sequence sequence_;
};

}  // namespace

std::unique_ptr<Dataset> make_sequence_dataset(Sequence sequence) {
  if (sequence.frames.empty()) {
    throw Error(sequence.location, "there are no images", "PNG, JPEG, PGM, TIFF and BMP images are looked for");
  }
  fit_calibration_to_images(sequence);
  const std::vector<std::string>& doubts = sequence.calibration.warnings;
  sequence.warnings.insert(sequence.warnings.end(), doubts.begin(), doubts.end());
  warn_about_time_order(sequence);
  warn_about_orientation(*sequence.images, sequence.frames, sequence.warnings);
  sequence.bits = used_bits(*sequence.images, sequence.frames, sequence.warnings);
  return std::make_unique<SequenceDataset>(std::move(sequence));
}

void read_ground_truth(Sequence& sequence, const std::function<Trajectory()>& read) {
  try {
    sequence.ground_truth = read();
  } catch (const Error& error) {
    sequence.warnings.push_back(std::string("the ground truth is ignored: ") + error.what());
  }
}

}  // namespace ldso
