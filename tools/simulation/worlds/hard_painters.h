#pragma once

// Idea: surfaces on which a direct method has little to go by: weak contrast, straight edges, the same again and again.

#include <cstdint>

#include "simulation/worlds/canvas.h"

namespace ldso::simulation {

/// Moves every value towards the mean until `share` of the contrast is left.
void reduce_contrast(Canvas& canvas, float share);

/// Blossoms on stripes that repeat exactly every 10 to 16 cm in both directions, over the whole canvas.
void paint_repetitive_wallpaper(Canvas& canvas, std::uint64_t seed);

/// A wide window: straight bars before an overcast sky and hazy hills, both of weak contrast.
void paint_panorama(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed);

/// Posters of all sizes close together, each another one.
void paint_posters(Canvas& canvas, std::uint64_t seed);

}  // namespace ldso::simulation
