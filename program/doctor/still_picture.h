#pragma once
// What stays where it is in the image while the camera moves: text and logos that were drawn over it, parts of the
// vehicle or the hand that carries it.

#include <cstdint>
#include <vector>

#include "ldso/image.h"

namespace ldso {

/// A rectangle of pixels.
struct StillRegion {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Gathers frames that are far from each other.
class StillPicture {
 public:
  /// Grey levels 0..255; all of one size.
  void add(ImageView<const float> grey);

  int frames() const { return frames_; }
  /// Of each pixel the largest grey level.
  const Image<float>& brightest() const { return brightest_; }
  /// Median over the pixels of the standard deviation of their grey levels: small if the camera stands.
  double change() const;

  /// Pixels with an edge that is the same in all frames, 255, the others 0. Empty if the scene hardly changes.
  Image<std::uint8_t> still_edges() const;

 private:
  struct Sums {
    float dx = 0, dy = 0, length = 0, grey = 0, squares = 0;
  };
  int frames_ = 0;
  Image<float> brightest_;
  Image<Sums> sums_;
};

/// Groups of still edges that are large enough for letters or a bonnet, without those in `ignored` (255; may be empty).
std::vector<StillRegion> still_regions(const Image<std::uint8_t>& edges, const Image<std::uint8_t>& ignored);

}  // namespace ldso
