// Images: frames and vignettes. What is large by its own header is left out, since unpacking it takes too long here.

#include "fuzz_target.h"
#include "io/images/exif.h"
#include "io/images/image_file.h"
#include "io/images/image_header.h"

using namespace ldso;

namespace {

constexpr std::int64_t kMostPixelsHere = 1 << 20;

void check(const Image<float>& image, float least, float most) {
  fuzz::expect(image.width() > 0 && image.height() > 0, "an image has pixels");
  for (std::size_t i = 0; i < image.size(); ++i)
    fuzz::expect(image.data()[i] >= least && image.data()[i] <= most, "grey levels are within their range");
}

}  // namespace

LDSO_FUZZ_TARGET(image) {
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  const int orientation = exif_orientation(bytes);
  fuzz::expect(orientation >= 1 && orientation <= 8, "an orientation is one of eight");
  fuzz::expect(exif_focal_35mm(bytes).value_or(1) > 0, "a focal length is positive");
  const auto header = fuzz::accepted([&] { return read_image_header(bytes, "image"); });
  if (header && std::int64_t{header->width} * header->height > kMostPixelsHere) return;
  const auto image = fuzz::accepted([&] { return decode_grey_image(bytes, "image"); });
  if (!image) return;
  fuzz::expect(header.has_value(), "what is decoded has a header");
  check(*image, 0, 255);
  const auto vignette = fuzz::accepted([&] { return read_vignette(fuzz::scratch_file("vignette.png", input)); });
  if (vignette) check(*vignette, 1e-3F, 1);
}
