#include "simulation/sequences/sequence_recipe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

SequenceRecipe coarse(const std::string& world, const std::string& style = "", const std::string& motion = "") {
  SequenceRecipe recipe;
  recipe.world = world;
  recipe.style = style;
  recipe.motion = motion;
  recipe.texel_scale = world == "street" ? 16 : 8;
  recipe.scale = world == "street" ? 0.6 : 1;
  recipe.width = world == "street" ? 306 : 160;
  recipe.height = world == "street" ? 92 : 120;
  return recipe;
}

double mean_of(const Image<float>& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i) sum += image.data()[i];
  return sum / static_cast<double>(image.size());
}

/// Mean step to the next pixel in comparison with the mean.
double contrast_of(const Image<float>& image) {
  double sum = 0;
  for (std::size_t i = 1; i < image.size(); ++i) sum += std::abs(image.data()[i] - image.data()[i - 1]);
  return sum / static_cast<double>(image.size()) / mean_of(image);
}

bool same(const Image<float>& a, const Image<float>& b) {
  return a.size() == b.size() && std::equal(a.data(), a.data() + a.size(), b.data());
}

TEST(SequenceRecipe, TheSameSeedGivesTheSameImages) {
  for (SequenceRecipe recipe : {coarse("wall", "", "slow"), coarse("window_room", "wallpaper")}) {
    recipe.frames = 8;
    const RawFrame frame = make_sequence(recipe, nullptr).render(7);
    ThreadPool pool(2);
    EXPECT_TRUE(same(frame.grey, make_sequence(recipe, &pool).render(7, &pool).grey)) << recipe.world;
    recipe.seed = 2;
    EXPECT_FALSE(same(frame.grey, make_sequence(recipe, nullptr).render(7).grey)) << recipe.world;
  }
}

TEST(SequenceRecipe, TheMotionIsTheOneAskedFor) {
  const SimulatedSequence standing = make_sequence(coarse("wall", "", "standing"), nullptr);
  EXPECT_GT(standing.size(), 1000);
  EXPECT_EQ(standing.path_length(), 0);
  EXPECT_GT(make_sequence(coarse("wall"), nullptr).path_length(), 5);
}

TEST(SequenceRecipe, TheWeakRoomHasAFractionOfTheContrast) {
  SequenceRecipe recipe = coarse("room");
  recipe.fps = 1;
  const SimulatedSequence usual = make_sequence(recipe, nullptr);
  recipe.style = "weak";
  const SimulatedSequence weak = make_sequence(recipe, nullptr);
  for (const int i : {0, 10, 20}) {
    EXPECT_LT(contrast_of(weak.irradiance(i)), 0.7 * contrast_of(usual.irradiance(i))) << i;
    // It is the same room.
    EXPECT_TRUE(same(weak.depth(i), usual.depth(i))) << i;
  }
}

TEST(SequenceRecipe, TheDarkRoomIsNoisierInComparison) {
  SequenceRecipe recipe = coarse("room");
  recipe.frames = 12;
  const double light = mean_of(make_sequence(recipe, nullptr).irradiance(10));
  recipe.style = "dark";
  const SimulatedSequence dark = make_sequence(recipe, nullptr);
  EXPECT_NEAR(mean_of(dark.irradiance(10)) / light, 0.1, 1e-3);
  EXPECT_GT(mean_of(dark.render(10).grey), 8);  // Something is left to be seen.
}

TEST(SequenceRecipe, HalfOfTheOpenStreetIsSky) {
  const auto sky_of = [](const std::string& style) {
    SequenceRecipe recipe = coarse("street", style);
    recipe.fps = 1;
    const SimulatedSequence street = make_sequence(recipe, nullptr);
    double sky = 0;
    for (int i = 0; i < street.size(); i += street.size() / 20) {
      const Image<float> depth = street.depth(i);
      sky += static_cast<double>(std::count(depth.data(), depth.data() + depth.size(), 0.0f)) /
             static_cast<double>(depth.size()) / 20;
    }
    return sky;
  };
  const double open = sky_of("open");
  EXPECT_GT(open, 0.4);
  EXPECT_LT(open, 0.55);
  EXPECT_LT(sky_of(""), 0.6 * open);
}

TEST(SequenceRecipe, RefusesStylesAndMotionsOfOtherWorlds) {
  EXPECT_THROW(make_sequence(coarse("corridor", "weak"), nullptr), Error);
  EXPECT_THROW(make_sequence(coarse("street", "dark"), nullptr), Error);
  EXPECT_THROW(make_sequence(coarse("room", "open"), nullptr), Error);
  EXPECT_THROW(make_sequence(coarse("room", "striped"), nullptr), Error);
  EXPECT_THROW(make_sequence(coarse("room", "", "orbit"), nullptr), Error);
  EXPECT_THROW(make_sequence(coarse("wall", "", "dancing"), nullptr), Error);
}

}  // namespace
}  // namespace ldso::simulation
