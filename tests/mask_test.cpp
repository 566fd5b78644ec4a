// What is masked is not used: a picture that is drawn over a rendered sequence and moves against it does no harm, and
// no point of the map lies in it.

#include <gtest/gtest.h>

#include <cmath>

#include "ldso/sequence_run.h"
#include "rendered_dataset.h"

namespace ldso {
namespace {

constexpr int kLeft = 90, kTop = 60, kWidth = 150, kHeight = 110;

bool is_masked(int x, int y) { return x >= kLeft && x < kLeft + kWidth && y >= kTop && y < kTop + kHeight; }

/// A part of each image, though it shows nothing but the room.
void mask(test::RenderedDataset& dataset) {
  for (RawFrame& frame : dataset.frames) {
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (is_masked(x, y)) frame.grey(x, y) = -1;
      }
    }
  }
}

test::RenderedDataset make_room() {
  simulation::SequenceRecipe recipe;
  recipe.world = "room";
  recipe.lens = "pinhole";
  recipe.width = 320;
  recipe.height = 240;
  recipe.frames = 100;
  recipe.texel_scale = 2;
  return test::RenderedDataset(recipe);
}

int points_masked(const SlamResult& result) {
  int count = 0;
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    for (const MapPoint& point : keyframe.points)
      count += is_masked(static_cast<int>(std::lround(point.u)), static_cast<int>(std::lround(point.v))) ? 1 : 0;
  }
  return count;
}

TEST(Mask, KeepsPointsOutOfIt) {
  const test::RenderedDataset plain = make_room();
  test::RenderedDataset masked = plain;
  mask(masked);
  Settings settings;
  settings.loops.enabled = false;
  const SlamResult without = run_sequence(plain, settings).result, with = run_sequence(masked, settings).result;
  EXPECT_GT(points_masked(without), 100);
  EXPECT_EQ(points_masked(with), 0);
  EXPECT_GT(with.trajectory().size(), 90u);
}

}  // namespace
}  // namespace ldso
