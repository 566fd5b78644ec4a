#include "io/images/exif.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "io/images/image_file.h"

namespace ldso {
namespace {

using JpegBytes = std::vector<std::uint8_t>;

/// A JPEG of 32x16 pixels, dark on its left and bright on its right, with an EXIF segment in either byte order.
JpegBytes jpeg_with_orientation(std::uint8_t orientation, bool big_endian) {
  cv::Mat image(16, 32, CV_8UC1, cv::Scalar(20));
  image.colRange(16, 32).setTo(220);
  JpegBytes bytes;
  cv::imencode(".jpg", image, bytes);
  JpegBytes exif{0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0};
  const JpegBytes big{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0, 0, 0, 0, 0};
  const JpegBytes little{'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 18, 1, 3, 0, 1, 0, 0, 0, orientation, 0, 0, 0, 0, 0, 0, 0};
  const JpegBytes& tiff = big_endian ? big : little;
  exif.insert(exif.end(), tiff.begin(), tiff.end());
  bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
  return bytes;
}

TEST(ImageOrientation, IsReadFromEitherByteOrder) {
  for (const std::uint8_t orientation : {1, 3, 6, 8}) {
    EXPECT_EQ(exif_orientation(jpeg_with_orientation(orientation, true)), orientation);
    EXPECT_EQ(exif_orientation(jpeg_with_orientation(orientation, false)), orientation);
  }
}

TEST(ImageOrientation, ImagesAreDecodedAsTheyAreStored) {
  for (const std::uint8_t orientation : {3, 6, 8}) {
    const Image<float> image = decode_grey_image(jpeg_with_orientation(orientation, false), "turned.jpg");
    ASSERT_EQ(image.width(), 32) << int{orientation};
    ASSERT_EQ(image.height(), 16);
    EXPECT_LT(image(4, 8), 40);
    EXPECT_GT(image(28, 8), 200);
  }
}

/// A JPEG whose EXIF says the focal length in a directory of its own.
JpegBytes jpeg_with_focal_length(std::uint8_t millimetres) {
  JpegBytes bytes;
  cv::imencode(".jpg", cv::Mat(16, 32, CV_8UC1, cv::Scalar(20)), bytes);
  const JpegBytes tiff{'I', 'I', 42, 0, 8, 0, 0, 0,    1, 0, 0x69, 0x87, 4, 0, 1,           0, 0, 0, 26, 0, 0, 0,
                       0,   0,   0,  0, 1, 0, 5, 0xa4, 3, 0, 1,    0,    0, 0, millimetres, 0, 0, 0, 0,  0, 0, 0};
  JpegBytes exif{0xff, 0xe1, 0, static_cast<std::uint8_t>(8 + tiff.size()), 'E', 'x', 'i', 'f', 0, 0};
  exif.insert(exif.end(), tiff.begin(), tiff.end());
  bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
  return bytes;
}

TEST(ExifFocalLength, IsReadIfThereIsOne) {
  EXPECT_EQ(exif_focal_35mm(jpeg_with_focal_length(26)), 26);
  EXPECT_FALSE(exif_focal_35mm(jpeg_with_focal_length(0)));
  EXPECT_FALSE(exif_focal_35mm(jpeg_with_orientation(6, true)));
  EXPECT_FALSE(exif_focal_35mm({}));
  const JpegBytes whole = jpeg_with_focal_length(26);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(exif_focal_35mm({whole.data(), size}).value_or(26), 26) << size;
}

TEST(ImageOrientation, IsNoneOfWhatIsDamaged) {
  EXPECT_EQ(exif_orientation({}), 1);
  EXPECT_EQ(exif_orientation(jpeg_with_orientation(9, true)), 1);
  const JpegBytes whole = jpeg_with_orientation(6, true);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const int orientation = exif_orientation({whole.data(), size});
    EXPECT_TRUE(orientation == 1 || orientation == 6) << size;
  }
}

}  // namespace
}  // namespace ldso
