#pragma once
// The square markers that boards carry: AprilTag families and ArUco dictionaries, by the names they are known by.

#include <cstdint>
#include <string>
#include <vector>

#include "ldso/image.h"

namespace ldso {

/// Markers in it: of "36h11", "5x5_100", ...; 0 if there is no such dictionary.
int marker_dictionary_size(const std::string& name);

/// All names, for messages.
std::string marker_dictionary_names();

/// A pixel for each cell: 0 black, 255 white; the outermost `border` rings are black.
Image<std::uint8_t> draw_marker(const std::string& dictionary, int id, int border = 1);

/// A marker in an image: corners [px] go round it in the same direction as in the drawing, from whichever.
struct SeenMarker {
  int id = 0;
  std::vector<std::pair<double, double>> corners;
};

/// `grey`: row-major levels 0..255. Corners are within a pixel or two.
std::vector<SeenMarker> find_markers(const Image<std::uint8_t>& grey, const std::string& dictionary, int border = 1);

}  // namespace ldso
