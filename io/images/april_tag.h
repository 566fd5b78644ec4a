#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ldso/image.h"

namespace ldso {

// AprilTags (E. Olson, "AprilTag: A robust and flexible visual fiducial system", ICRA 2011): black squares with an id,
// printed by many programs. Families: "16h5", "25h9", "36h10", "36h11".

/// Ids that a family has, from 0; 0 if there is no such family.
int april_tag_count(const std::string& family);

/// The tag, a pixel for each of its cells: 0 black, 255 white. Its outermost ring is the black border; around it goes
/// at least one cell of white that is not in the image. The id must be one of the family's.
Image<std::uint8_t> draw_april_tag(const std::string& family, int id);

/// A tag and its size: the side of its black square [m].
struct AprilTag {
  std::string family;
  int id = 0;
  double metres = 0;
};

/// "36h11:3:0.16"; the family may be called "tag36h11" as well. Throws Error that calls the text `where` if it is none,
/// or if there is no such family or id.
AprilTag parse_april_tag(const std::string& text, const std::string& where);

struct SeenTag {
  int id = 0;
  /// Of the black square [px], in the order in which they go round it.
  std::array<Eigen::Vector2d, 4> corners;
};

/// The tags of a family in an image (grey levels 0..255), with corners to a fraction of a pixel. Best are grey levels
/// in proportion to the light: a response that is not undone moves edges towards black.
std::vector<SeenTag> find_april_tags(ImageView<const float> grey, const std::string& family);

}  // namespace ldso
