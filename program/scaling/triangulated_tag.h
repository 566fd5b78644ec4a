#pragma once
// The size that a tag has in the map.

#include <optional>
#include <vector>

#include "scaling/tag_views.h"

namespace ldso {

struct TriangulatedTag {
  double side = 0;             ///< [map units]
  double relative_stddev = 0;  ///< Of the side.
};

/// Each corner is put where its rays meet, then a square through the four. Nothing for fewer than three views or rays
/// that do not meet before the camera.
std::optional<TriangulatedTag> triangulate_tag(const std::vector<TagView>& views);

}  // namespace ldso
