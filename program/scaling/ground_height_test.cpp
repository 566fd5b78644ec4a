#include "scaling/ground_height.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ldso {
namespace {

struct Street {
  double height = 1.5;
  double pitch = 0.03;        ///< Of the camera [rad].
  double ground_share = 0.6;  ///< Of the points below the horizon; the others stand higher.
  double growth = 1;          ///< Of the height from the first to the last keyframe.
};

SlamResult drive(const Street& street) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> column(0, 640), row(0, 480), share(0, 1);
  std::normal_distribution<double> noise(0, 0.02);
  SlamResult result;
  constexpr int kCount = 60;
  for (int i = 0; i < kCount; ++i) {
    KeyframeUpdate keyframe;
    keyframe.frame_id = i;
    keyframe.camera = {640, 480, 500, 500, 320, 240};
    // It drives along the ground, which the camera looks down to by its pitch.
    keyframe.T_world_camera = SE3d(SO3d(), {0, -std::sin(street.pitch) * i, std::cos(street.pitch) * i});
    const double height = street.height * std::pow(street.growth, i / (kCount - 1.0));
    for (int k = 0; k < 300; ++k) {
      const double u = column(random), v = row(random);
      const Eigen::Vector3d d((u - 320) / 500, (v - 240) / 500, 1);
      const double down = std::cos(street.pitch) * d.y() + std::sin(street.pitch) * d.z();
      if (down < 0.01) continue;
      const double level = share(random) < street.ground_share ? 1 : 0.2 + 0.75 * share(random);
      const double idepth = down / (level * height) * (1 + noise(random));
      keyframe.points.push_back({static_cast<float>(u), static_cast<float>(v), static_cast<float>(idepth),
                                 static_cast<float>(0.02 * idepth), 90, false});
    }
    result.keyframes.push_back(keyframe);
  }
  return result;
}

TEST(GroundHeight, IsMeasuredAmongOtherThings) {
  const auto ground = measure_ground(drive({}));
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->height, 1.5, 0.015 * 1.5);
  EXPECT_LT(ground->relative_stddev, 0.02);
  EXPECT_NEAR(ground->growth, 1, 0.03);
}

TEST(GroundHeight, ShowsTheDriftOfTheScale) {
  Street street;
  street.growth = 1.1;
  const auto ground = measure_ground(drive(street));
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->growth, 1.1, 0.03);
}

TEST(GroundHeight, CountsInTheUnitOfTheWorld) {
  SlamResult result = drive({});
  for (const KeyframeUpdate& keyframe : result.keyframes)
    result.corrected.push_back(Sim3d(keyframe.T_world_camera.rotation(), keyframe.T_world_camera.translation(), 2));
  const auto ground = measure_ground(result);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->height, 3, 0.06);
}

TEST(GroundHeight, IsNotMadeUp) {
  Street street;
  street.ground_share = 0;
  EXPECT_FALSE(measure_ground(drive(street)));
  EXPECT_FALSE(measure_ground(SlamResult()));
}

}  // namespace
}  // namespace ldso
