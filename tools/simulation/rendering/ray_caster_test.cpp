#include "simulation/rendering/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ldso/error.h"
#include "simulation/rendering/noise.h"

namespace ldso::simulation {
namespace {

constexpr int kWidth = 70, kHeight = 50;
constexpr double kFocal = 60;

CameraRays pinhole_rays() {
  return CameraRays(kWidth, kHeight,
                    [](double u, double v) { return Eigen::Vector2d((u - 34.5) / kFocal, (v - 24.5) / kFocal); });
}

Surface surface(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                int texture) {
  Surface s;
  s.origin = origin;
  s.edge_u = edge_u;
  s.edge_v = edge_v;
  s.base.texture = texture;
  return s;
}

/// A white wall at z = 10 that fills the view.
Scene wall_scene() {
  Scene scene;
  scene.add_texture(Texture(Image<float>(8, 8, 1.0f)));
  scene.add_texture(Texture(Image<float>(8, 8, 0.0f)));
  scene.add(surface({-50, -50, 10}, {100, 0, 0}, {0, 100, 0}, 0));
  return scene;
}

Image<float> radiance_of(const Scene& scene, const SE3d& pose = SE3d()) {
  const CameraRays rays = pinhole_rays();
  Image<float> radiance;
  RayCaster(scene, rays).render({pose}, {&radiance, nullptr}, nullptr);
  return radiance;
}

Image<float> depth_of(const Scene& scene, const SE3d& pose = SE3d()) {
  const CameraRays rays = pinhole_rays();
  Image<float> depth;
  RayCaster(scene, rays).render({pose}, {nullptr, &depth}, nullptr);
  return depth;
}

double sum_of(const Image<float>& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i) sum += image.data()[i];
  return sum;
}

/// Many random quads and triangles.
Scene clutter(std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  Image<float> image(64, 64);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = static_cast<float>(random.uniform());
  scene.add_texture(Texture(image));
  const auto direction = [&] {
    return Eigen::Vector3d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
  };
  for (int i = 0; i < 300; ++i) {
    Surface s =
        surface({random.uniform(-6, 6), random.uniform(-5, 5), random.uniform(-3, 12)}, direction(), direction(), 0);
    s.two_sided = random.chance(0.7);
    s.triangle = random.chance(0.5);
    s.base.s_u = s.base.t_v = 64;
    scene.add(s);
  }
  scene.finish();
  return scene;
}

/// Depth by testing every surface, in double precision.
double brute_force_depth(const Scene& scene, const Eigen::Vector3d& ray) {
  double nearest = 1e30;
  for (const Surface& s : scene.surfaces()) {
    Eigen::Matrix3d A;
    A << s.edge_u, s.edge_v, -ray;
    const double c = s.edge_u.cross(s.edge_v).dot(s.origin);
    if (c <= 0 && !s.two_sided) continue;
    const Eigen::Vector3d x = A.inverse() * -s.origin;
    const bool inside = x[0] >= 0 && x[1] >= 0 && (s.triangle ? x[0] + x[1] <= 1 : x[0] <= 1 && x[1] <= 1);
    if (inside && x[2] > 0) nearest = std::min(nearest, x[2]);
  }
  return nearest > 1e29 ? 0 : nearest;
}

TEST(RayCaster, DepthOfAWallIsItsDistance) {
  Scene scene = wall_scene();
  scene.finish();
  SE3d pose;
  pose.translation() = {1, 2, 3};
  const Image<float> depth = depth_of(scene, pose);
  for (std::size_t i = 0; i < depth.size(); ++i) EXPECT_NEAR(depth.data()[i], 7, 1e-4);
}

TEST(RayCaster, AgreesWithTestingEverySurface) {
  const Scene scene = clutter(7);
  const Image<float> depth = depth_of(scene);
  int different = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double expected = brute_force_depth(scene, {(u - 34.5) / kFocal, (v - 24.5) / kFocal, 1});
      if (std::abs(depth(u, v) - expected) > 1e-3 * (1 + expected)) ++different;
    }
  }
  // Rounding may decide differently where a ray meets an edge.
  EXPECT_LE(different, kWidth * kHeight / 500);
}

TEST(RayCaster, IsSeenFromOneSideOnly) {
  Scene scene;
  scene.add_texture(Texture(Image<float>(8, 8, 1.0f)));
  scene.add(surface({50, -50, 10}, {-100, 0, 0}, {0, 100, 0}, 0));
  scene.finish();
  EXPECT_EQ(sum_of(depth_of(scene)), 0);
}

TEST(RayCaster, OutlinesAreCoveredByTheirArea) {
  // A black square in front of the white wall, its border within pixels: the dark area must be exact wherever it lies.
  for (const double shift : {0.0, 0.013, 0.029, 0.041}) {
    Scene scene = wall_scene();
    scene.add(surface({-0.9 + shift, -0.8, 5}, {1.77, 0, 0}, {0, 1.61, 0}, 1));
    scene.finish();
    const double dark = kWidth * kHeight - sum_of(radiance_of(scene));
    EXPECT_NEAR(dark, 1.77 * 1.61 * (kFocal / 5) * (kFocal / 5), 3.0) << shift;
  }
}

TEST(RayCaster, ThingsThinnerThanAPixelAreSeen) {
  // A post a quarter of a pixel wide may fall between all pixel centres.
  for (const double shift : {0.0, 0.02, 0.04, 0.06}) {
    Scene scene = wall_scene();
    const double width = 0.25 * 5 / kFocal;
    scene.add(surface({0.1 + shift, -20, 5}, {width, 0, 0}, {0, 40, 0}, 1));
    scene.finish();
    const double dark = kWidth * kHeight - sum_of(radiance_of(scene));
    EXPECT_NEAR(dark, 0.25 * kHeight, 0.06 * kHeight) << shift;
  }
}

TEST(RayCaster, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene = clutter(8);
  const CameraRays rays = pinhole_rays();
  Image<float> expected, depth;
  RayCaster(scene, rays).render({SE3d()}, {&expected, &depth}, nullptr);
  for (const int threads : {2, 4}) {
    ThreadPool pool(threads);
    Image<float> radiance;
    RayCaster(scene, rays).render({SE3d()}, {&radiance, nullptr}, &pool);
    for (std::size_t i = 0; i < radiance.size(); ++i) ASSERT_EQ(radiance.data()[i], expected.data()[i]);
  }
}

TEST(RayCaster, RowsOfARollingShutterHaveTheirOwnPose) {
  const Scene scene = clutter(9);
  const CameraRays rays = pinhole_rays();
  std::vector<SE3d> poses;
  for (int row = 0; row < kHeight; ++row) {
    poses.push_back(SE3d::exp((SE3d::Tangent() << 0.01 * row, 0, 0.002 * row, 0, 0.001 * row, 0).finished()));
  }
  Image<float> depth;
  RayCaster(scene, rays).render(poses, {nullptr, &depth}, nullptr);
  for (const int row : {0, 17, kHeight - 1}) {
    const Image<float> expected = depth_of(scene, poses[row]);
    int different = 0;
    for (int u = 0; u < kWidth; ++u) different += std::abs(depth(u, row) - expected(u, row)) > 1e-3 ? 1 : 0;
    EXPECT_LE(different, 1);
  }
  poses.pop_back();
  EXPECT_THROW(RayCaster(scene, rays).render(poses, {nullptr, &depth}, nullptr), Error);
}

}  // namespace
}  // namespace ldso::simulation
