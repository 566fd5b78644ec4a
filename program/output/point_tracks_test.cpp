#include "output/point_tracks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

const PinholeIntrinsics kTrackCamera{160, 120, 120, 120, 79.5, 59.5};
constexpr double kTrackDepth = 2;

Rgb texture(double x, double y) {
  const double v = std::sin(35 * x + 3 * std::sin(9 * y)) + std::sin(31 * y + 2 * std::sin(11 * x));
  const auto level = static_cast<std::uint8_t>(std::lround(128 + 55 * v));
  return {level, static_cast<std::uint8_t>(level / 2), 0};
}

/// The plane z = 2 from a camera at (x, y, 0).
TrackedImage view(std::int64_t id, double x, double y) {
  TrackedImage view;
  view.id = id;
  view.T_world_camera = SE3d(SO3d(), {x, y, 0});
  view.image = Image<Rgb>(kTrackCamera.width, kTrackCamera.height);
  for (int v = 0; v < view.image.height(); ++v) {
    for (int u = 0; u < view.image.width(); ++u) {
      const Eigen::Vector3d p = kTrackDepth * viewing_ray(kTrackCamera, Eigen::Vector2d(u, v));
      view.image(u, v) = texture(x + p.x(), y + p.y());
    }
  }
  return view;
}

RecordedMap plane_map() {
  protocol::Keyframe first, second;
  first.id = 10;
  first.links = {20};
  for (double y = 15.3; y < 105; y += 12) {
    for (double x = 15.6; x < 145; x += 12) {
      const Eigen::Vector3d p = kTrackDepth * viewing_ray(kTrackCamera, Eigen::Vector2d(x, y));
      first.points.push_back(p.cast<float>());
      first.depth_stddev.push_back(x < 80 ? 0.01F : 0.5F);
      first.intensity.push_back(100);
    }
  }
  second.id = 20;
  RecordedMap map;
  map.keyframes = {first, second};
  map.corrected = {Sim3d(), Sim3d(SO3d(), {0.2, 0, 0}, 1)};
  return map;
}

TEST(PointTracks, PointsAreWhereTheImageShowsThem) {
  const RecordedMap map = plane_map();
  PointTracks tracks({map, map.corrected}, kTrackCamera);
  tracks.add_keyframe(0, view(10, 0, 0));
  TrackedImage image = view(15, 0.1, 0.04);
  const std::vector<Sighting> right = tracks.find(image);
  ASSERT_GT(right.size(), 0.8 * static_cast<double>(map.keyframes[0].points.size()));
  for (const Sighting& sighting : right) EXPECT_LT((sighting.seen - sighting.predicted).norm(), 0.06);

  // A pose that is wrong by 0.8 px moves what is predicted, not what is seen.
  image.T_world_camera.translation().x() += 0.8 * kTrackDepth / kTrackCamera.fx;
  const std::vector<Sighting> wrong = tracks.find(image);
  ASSERT_GT(wrong.size(), 0.8 * static_cast<double>(right.size()));
  for (const Sighting& sighting : wrong)
    EXPECT_LT((sighting.seen - sighting.predicted - Eigen::Vector2d(0.8, 0)).norm(), 0.06);
}

TEST(PointTracks, TheirKeyframeShowsThemByDefinitionAndKnowsTheirColours) {
  const RecordedMap map = plane_map();
  PointTracks tracks({map, map.corrected}, kTrackCamera);
  const TrackedImage image = view(10, 0, 0);
  EXPECT_FALSE(tracks.colors()[0]);
  tracks.add_keyframe(0, image);
  for (const Sighting& sighting : tracks.find(image)) {
    EXPECT_EQ(sighting.seen, sighting.predicted);
    const Eigen::Vector2d nearest = sighting.seen.array().round();
    EXPECT_EQ(tracks.colors()[sighting.point], image.image(int(nearest.x()), int(nearest.y())));
  }
}

TEST(PointTracks, OnlyCertainPointsAndOnlyFramesOfTheirWindow) {
  const RecordedMap map = plane_map();
  PointTracks tracks({map, map.corrected, 0.1}, kTrackCamera);
  EXPECT_LT(tracks.positions().size(), 0.6 * static_cast<double>(map.keyframes[0].points.size()));
  tracks.add_keyframe(0, view(10, 0, 0));
  EXPECT_FALSE(tracks.find(view(20, 0.1, 0)).empty());
  EXPECT_TRUE(tracks.find(view(9, 0.1, 0)).empty());
  EXPECT_TRUE(tracks.find(view(21, 0.1, 0)).empty());
}

TEST(PointTracks, WhatLooksOtherwiseIsNotSeen) {
  const RecordedMap map = plane_map();
  PointTracks tracks({map, map.corrected}, kTrackCamera);
  tracks.add_keyframe(0, view(10, 0, 0));
  TrackedImage elsewhere = view(15, 7, 3);
  elsewhere.T_world_camera = SE3d(SO3d(), {0.1, 0, 0});
  EXPECT_LT(tracks.find(elsewhere).size(), 0.1 * static_cast<double>(map.keyframes[0].points.size()));
}

}  // namespace
}  // namespace ldso
