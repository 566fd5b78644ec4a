#pragma once

// Idea: what surfaces look like. Each painter fills a canvas for one kind of surface; its seed makes every one
// distinct.

#include <cstdint>

#include "simulation/rendering/texture.h"
#include "simulation/worlds/canvas.h"

namespace ldso::simulation {

// Ground coats.
void paint_plaster(Canvas& canvas, float albedo, std::uint64_t seed);
/// Courses of bricks (or of stones, if they are large) with mortar joints, each stone with a tone of its own.
void paint_bricks(Canvas& canvas, double length, double height, float albedo, float joint, std::uint64_t seed);
/// Boards along x with grain.
void paint_planks(Canvas& canvas, double board, float albedo, std::uint64_t seed);
void paint_tiles(Canvas& canvas, double side, float albedo, float contrast, std::uint64_t seed);
void paint_metal(Canvas& canvas, float albedo, std::uint64_t seed);

// Whole things.
/// Front of a house with windows, a door, perhaps a shop; `storeys` high.
void paint_facade(Canvas& canvas, int storeys, bool front, std::uint64_t seed);
void paint_roof(Canvas& canvas, std::uint64_t seed);
void paint_car_side(Canvas& canvas, std::uint64_t seed);
void paint_car_end(Canvas& canvas, std::uint64_t seed);
/// A picture or poster that fills the rectangle: landscape, blocks, portrait-like shapes or text.
void paint_picture(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed);
void paint_door(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed);
/// Spines of books standing side by side.
void paint_books(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed);
void paint_carpet(Canvas& canvas, std::uint64_t seed);
void paint_window(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed);
void paint_wallpaper(Canvas& canvas, float albedo, std::uint64_t seed);

/// Soft clouds for Scene::set_sky.
Texture make_sky(std::uint64_t seed);
/// Repeating fine structure with mean Scene::kDetailMean.
Texture make_detail(std::uint64_t seed);
/// Repeating leaves.
Texture make_foliage(std::uint64_t seed);

}  // namespace ldso::simulation
