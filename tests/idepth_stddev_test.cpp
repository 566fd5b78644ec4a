// The map says how certain its inverse depths are: rendered worlds tell whether that is true.

#include <gtest/gtest.h>

#include <string>

#include "depth_errors.h"
#include "simulation/sequences/sequence_recipe.h"

namespace ldso {
namespace {

/// What is farther off than so many standard deviations is an outlier, a point on an edge in depth for instance.
constexpr double kInlier = 4;

class IdepthStddev : public testing::TestWithParam<std::string> {};

/// The square of a Gaussian error in its standard deviations has the median 0.45 and the mean 1; with the heavier tails
/// of true errors the median is lower. Without the residuals' size and correlation it would be 7 to 46.
TEST_P(IdepthStddev, IsThatOfTheError) {
  simulation::SequenceRecipe recipe;
  recipe.world = GetParam();
  recipe.width = 320;
  recipe.height = 240;
  recipe.frames = 100;
  recipe.texel_scale = 2;
  ThreadPool pool(2);
  const test::DepthErrors errors =
      test::depth_errors(simulation::make_sequence(recipe, &pool), Settings{}, recipe.frames, pool);
  RecordProperty("median", std::to_string(errors.median_squared()));
  RecordProperty("mean", std::to_string(errors.mean_squared_of_inliers(kInlier)));
  ASSERT_GT(errors.squared.size(), 1000u);
  EXPECT_GT(errors.median_squared(), 0.45 / 4);
  EXPECT_LT(errors.median_squared(), 0.45 * 2);
  EXPECT_GT(errors.mean_squared_of_inliers(kInlier), 0.5);
  EXPECT_LT(errors.mean_squared_of_inliers(kInlier), 2);
  EXPECT_GT(errors.inlier_share(kInlier), 0.85);
}

INSTANTIATE_TEST_SUITE_P(Worlds, IdepthStddev, testing::Values("room", "corridor"),
                         [](const auto& world) { return world.param; });

}  // namespace
}  // namespace ldso
