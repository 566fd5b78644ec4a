#include "simulation/sequences/stand_ins.h"

namespace ldso::simulation {
namespace {

SequenceRecipe recipe_of(const char* world, std::uint64_t seed, int width, int height, double fps) {
  SequenceRecipe recipe;
  recipe.world = world;
  recipe.seed = seed;
  recipe.width = width;
  recipe.height = height;
  recipe.fps = fps;
  return recipe;
}

StandIn tum_mono(const char* name, SequenceRecipe recipe) {
  WriteOptions write;
  write.truth_at_ends = true;
  write.zip = true;  // As it is downloaded.
  return {"tum_mono", std::filesystem::path("tum_mono") / name, std::move(recipe), write};
}

StandIn euroc(const char* name, SequenceRecipe recipe) {
  WriteOptions write;
  write.layout = LayoutKind::kEuroc;
  recipe.lens = "radtan";
  recipe.sensor.response = false;  // Like the benchmark's cameras.
  return {"euroc", std::filesystem::path("euroc") / name, std::move(recipe), write};
}

StandIn kitti(const char* name, SequenceRecipe recipe) {
  WriteOptions write;
  write.layout = LayoutKind::kKitti;
  recipe.sensor.response = false;
  recipe.sensor.vignette = false;
  return {"kitti", std::filesystem::path("kitti") / "sequences" / name, std::move(recipe), write};
}

std::vector<StandIn> small_ones() {
  SequenceRecipe lap = recipe_of("room", 1, 320, 240, 6);
  lap.scale = 0.7;  // A little more than once round.
  SequenceRecipe flight = recipe_of("room", 2, 320, 204, 12);
  flight.frames = 60;
  SequenceRecipe drive = recipe_of("street", 4, 416, 126, 10);
  drive.scale = 0.4;
  drive.frames = 40;
  for (SequenceRecipe* recipe : {&lap, &flight, &drive}) recipe->texel_scale = 2;  // Nobody sees more in small images.
  return {tum_mono("sequence_01", lap), euroc("V1_01", flight), kitti("00", drive)};
}

std::vector<StandIn> full_ones() {
  SequenceRecipe block = recipe_of("street", 4, 816, 246, 10), other_block = recipe_of("street", 3, 816, 246, 10);
  block.scale = 0.5;
  other_block.scale = 0.6;
  return {tum_mono("sequence_01", recipe_of("room", 1, 640, 480, 15)),
          tum_mono("sequence_02", recipe_of("corridor", 1, 640, 480, 12)),
          euroc("V1_01", recipe_of("room", 2, 752, 480, 15)),
          euroc("V1_02", recipe_of("room", 3, 752, 480, 15)),
          kitti("00", block),
          kitti("01", other_block)};
}

}  // namespace

std::vector<StandIn> stand_ins(StandInSize size) { return size == StandInSize::kSmall ? small_ones() : full_ones(); }

}  // namespace ldso::simulation
