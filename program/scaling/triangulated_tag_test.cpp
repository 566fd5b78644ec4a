#include "scaling/triangulated_tag.h"

#include <gtest/gtest.h>

#include <random>

namespace ldso {
namespace {

/// A tag of side 0.3 at z = 4, seen from cameras on a line of length `way`; directions are wrong by `noise` [rad].
std::vector<TagView> make_views(int count, double way, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0, noise);
  std::vector<TagView> views;
  for (int i = 0; i < count; ++i) {
    TagView view;
    view.ray_stddev = 4e-4;
    view.T_world_camera = SE3d(SO3d::exp({0.02 * i, -0.01 * i, 0.1}), {way * i / (count - 1), 0.1, 0});
    const Eigen::Vector2d corners[] = {{0, 0}, {0.3, 0}, {0.3, 0.3}, {0, 0.3}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d p = view.T_world_camera.inverse() * Eigen::Vector3d(corners[k].x(), corners[k].y(), 4);
      view.rays[k] = (p.normalized() + Eigen::Vector3d(error(random), error(random), 0)).normalized();
    }
    views.push_back(view);
  }
  return views;
}

TEST(TriangulatedTag, HasItsSize) {
  const auto exact = triangulate_tag(make_views(20, 2, 0));
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->side, 0.3, 1e-9);
  const auto noisy = triangulate_tag(make_views(40, 2, 4e-4));
  ASSERT_TRUE(noisy);
  EXPECT_NEAR(noisy->side, 0.3, 0.3 * 3 * noisy->relative_stddev);
  EXPECT_LT(noisy->relative_stddev, 0.005);
}

TEST(TriangulatedTag, OneWrongViewDoesNoHarm) {
  std::vector<TagView> views = make_views(40, 2, 4e-4);
  for (auto& ray : views[11].rays) ray = (ray + Eigen::Vector3d(0.05, 0, 0)).normalized();
  const auto tag = triangulate_tag(views);
  ASSERT_TRUE(tag);
  EXPECT_NEAR(tag->side, 0.3, 0.005 * 0.3);
}

TEST(TriangulatedTag, WithoutParallaxItIsUncertain) {
  const auto tag = triangulate_tag(make_views(20, 0.02, 4e-4));
  EXPECT_TRUE(!tag || tag->relative_stddev > 0.05);
  EXPECT_FALSE(triangulate_tag(make_views(2, 1, 0)));
}

}  // namespace
}  // namespace ldso
