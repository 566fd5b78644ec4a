#include "io/datasets/sequence_images.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "io/images/exif.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Images spread over the sequence whose largest value is looked for: some may be dark.
constexpr std::size_t kSampledImages = 12;

/// Of converters that are built into cameras.
constexpr std::array<int, 4> kBitsOfCameras{8, 10, 12, 14};

/// `read(bytes, name)` of image `index`; nothing if it cannot be read, which is said where it is played.
template <class Read>
auto try_to_read(const ImageSource& images, const FrameEntry& frame, const Read& read)
    -> decltype(read(std::vector<std::uint8_t>(), std::string())) {
  try {
    return read(images.read(frame.name), images.describe(frame.name));
  } catch (const Error&) {
    return {};
  }
}

int bits_for(int largest) {
  const auto fits = [=](int bits) { return largest < 1 << bits; };
  const auto found = std::find_if(kBitsOfCameras.begin(), kBitsOfCameras.end(), fits);
  return found == kBitsOfCameras.end() ? 16 : *found;
}

}  // namespace

int used_bits(const ImageSource& images, const std::vector<FrameEntry>& frames, std::vector<std::string>& warnings) {
  int largest = 0;
  const std::size_t count = std::min(kSampledImages, frames.size());
  for (std::size_t i = 0; i < count; ++i) {
    const FrameEntry& frame = frames[i * frames.size() / count];
    const std::optional<int> value = try_to_read(
        images, frame, [](const auto& bytes, const auto& name) { return largest_16_bit_value(bytes, name); });
    if (!value && i == 0) return 16;
    largest = std::max(largest, value.value_or(0));
    if (bits_for(largest) == 16) return 16;
  }
  if (largest == 0) return 16;
  const int bits = bits_for(largest);
  warnings.push_back(images.describe(frames.front().name) + ": the images have 16 bits, but no value of " +
                     std::to_string(count) + " of them is above " + std::to_string(largest) + ": they are taken for " +
                     std::to_string(bits) + " bits of a camera, " + std::to_string((1 << bits) - 1) + " as white");
  return bits;
}

void warn_about_orientation(const ImageSource& images, const std::vector<FrameEntry>& frames,
                            std::vector<std::string>& warnings) {
  if (frames.empty()) return;
  const int orientation =
      try_to_read(images, frames.front(), [](const auto& bytes, const auto&) { return exif_orientation(bytes); });
  if (orientation <= 1) return;
  warnings.push_back(images.describe(frames.front().name) +
                     ": viewers are asked to turn the images (EXIF orientation " + std::to_string(orientation) +
                     "); they are used as they are stored, since calibration and rolling shutter are about the rows of "
                     "the sensor");
}

}  // namespace ldso
