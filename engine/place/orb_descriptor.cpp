#include "place/orb_descriptor.h"

#include <opencv2/core.hpp>
#include <string>

#include "ldso/error.h"
#include "place/orb_on_grey.h"

namespace ldso {

DescribedCorners describe(const Image<Texel>& image, std::span<const Eigen::Vector2f> corners) {
  DescribedCorners described;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!has_room(corners[i], image.width(), image.height())) continue;
    described.features.push_back({{}, corners[i].x(), corners[i].y(), 0});
    described.corner_index.push_back(static_cast<int>(i));
  }
  if (described.features.empty()) return described;
  try {
    describe_on(to_8_bit(image), described.features);
  } catch (const cv::Exception& exception) {
    throw Error("description of corners", std::string("OpenCV says: ") + exception.what(), "");
  }
  return described;
}

}  // namespace ldso
