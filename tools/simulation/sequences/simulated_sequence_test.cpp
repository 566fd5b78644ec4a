#include "simulation/sequences/simulated_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ldso/error.h"
#include "simulation/sequences/sequence_recipe.h"

namespace ldso::simulation {
namespace {

SequenceRecipe small(const std::string& world) {
  SequenceRecipe recipe;
  recipe.world = world;
  recipe.texel_scale = world == "street" ? 4 : 2;
  recipe.scale = world == "street" ? 0.8 : 1;
  recipe.width = world == "street" ? 409 : 320;
  recipe.height = world == "street" ? 124 : 240;
  recipe.lens = "pinhole";
  recipe.sensor.exposure_changes = false;
  return recipe;
}

ThreadPool& pool() {
  static ThreadPool threads(2);
  return threads;
}

const SimulatedSequence& room() {
  static const SimulatedSequence kSequence = make_sequence(small("room"), &pool());
  return kSequence;
}

const SimulatedSequence& street() {
  static const SimulatedSequence kSequence = make_sequence(small("street"), &pool());
  return kSequence;
}

double interpolate(const Image<float>& image, double u, double v) {
  const int iu = static_cast<int>(u), iv = static_cast<int>(v);
  const double fu = u - iu, fv = v - iv;
  return (1 - fv) * ((1 - fu) * image(iu, iv) + fu * image(iu + 1, iv)) +
         fv * ((1 - fu) * image(iu, iv + 1) + fu * image(iu + 1, iv + 1));
}

/// Whether all depths around a pixel belong to one smooth surface.
bool smooth_around(const Image<float>& depth, int u, int v, double expected) {
  for (int dv = -2; dv <= 3; ++dv) {
    for (int du = -2; du <= 3; ++du) {
      if (!(std::abs(depth(u + du, v + dv) - expected) < 0.06 * expected)) return false;
    }
  }
  return true;
}

struct Consistency {
  double rms = 0, flow = 0;
  int pixels = 0;
};

/// Differences between frame i and frame j, taken over with the true depth and poses.
Consistency photometric_consistency(const SimulatedSequence& sequence, int i, int j) {
  const Image<float> from = sequence.irradiance(i, &pool()), to = sequence.irradiance(j, &pool());
  const Image<float> depth = sequence.depth(i, &pool()), depth_to = sequence.depth(j, &pool());
  const CameraCalibration& k = sequence.calibration().camera;
  const SE3d T = sequence.T_world_camera(j).inverse() * sequence.T_world_camera(i);
  Consistency result;
  for (int v = 3; v < k.height - 4; ++v) {
    for (int u = 3; u < k.width - 4; ++u) {
      const double z = depth(u, v);
      if (z <= 0 || !smooth_around(depth, u, v, z)) continue;
      const Eigen::Vector3d p = T * Eigen::Vector3d((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z);
      const double tu = k.fx * p.x() / p.z() + k.cx, tv = k.fy * p.y() / p.z() + k.cy;
      if (p.z() < 0.1 || !(tu > 3 && tv > 3 && tu < k.width - 5 && tv < k.height - 5)) continue;
      if (!smooth_around(depth_to, static_cast<int>(tu), static_cast<int>(tv), p.z())) continue;
      result.rms += std::pow(interpolate(to, tu, tv) - from(u, v), 2);
      result.flow += std::hypot(tu - u, tv - v);
      ++result.pixels;
    }
  }
  result.rms = std::sqrt(result.rms / result.pixels);
  result.flow /= result.pixels;
  return result;
}

// The point of the simulator: what the camera sees follows from depth and pose. The bounds are near the noise of a
// camera (1 to 2 grey levels); nearest-texel sampling or missing edge sampling exceed them several times.
TEST(SimulatedSequence, ImagesAgreeUnderTrueDepthAndPoseInTheRoom) {
  for (const int i : {4, 300, 700}) {
    const Consistency c = photometric_consistency(room(), i, i + 3);
    EXPECT_GT(c.pixels, 20000);
    EXPECT_GT(c.flow, 1.0);
    EXPECT_LT(c.rms, 2.0) << i;
  }
}

TEST(SimulatedSequence, ImagesAgreeUnderTrueDepthAndPoseInTheStreet) {
  for (const int i : {10, 150}) {
    const Consistency c = photometric_consistency(street(), i, i + 1);
    EXPECT_GT(c.pixels, 10000);
    EXPECT_GT(c.flow, 1.0);
    EXPECT_LT(c.rms, 3.0) << i;
  }
}

TEST(SimulatedSequence, WrongPosesDisagree) {
  // The same comparison must notice a wrong ground truth, else it proves nothing.
  const Consistency right = photometric_consistency(room(), 300, 303);
  const Image<float> from = room().irradiance(300), to = room().irradiance(303);
  double wrong = 0;
  for (std::size_t i = 0; i < from.size(); ++i) wrong += std::pow(to.data()[i] - from.data()[i], 2);
  EXPECT_GT(std::sqrt(wrong / static_cast<double>(from.size())), 3 * right.rms);
}

TEST(SimulatedSequence, FramesComeOutTheSameInAnyOrderAndWithAnyThreads) {
  const SimulatedSequence again = make_sequence(small("room"), nullptr);
  const RawFrame late = again.render(40), early = again.render(3);
  const RawFrame first = room().render(3, &pool()), second = room().render(40, &pool());
  ASSERT_EQ(early.grey.size(), first.grey.size());
  for (std::size_t i = 0; i < early.grey.size(); ++i) {
    ASSERT_EQ(early.grey.data()[i], first.grey.data()[i]);
    ASSERT_EQ(late.grey.data()[i], second.grey.data()[i]);
  }
}

TEST(SimulatedSequence, ImagesUseTheRangeOfGreyLevels) {
  for (const SimulatedSequence* sequence : {&room(), &street()}) {
    const RawFrame frame = sequence->render(20, &pool());
    double sum = 0, squares = 0;
    int saturated = 0;
    for (std::size_t i = 0; i < frame.grey.size(); ++i) {
      const double v = frame.grey.data()[i];
      sum += v;
      squares += v * v;
      saturated += v >= 254 ? 1 : 0;
    }
    const double mean = sum / static_cast<double>(frame.grey.size());
    EXPECT_GT(mean, 60);
    EXPECT_LT(mean, 180);
    EXPECT_GT(std::sqrt(squares / static_cast<double>(frame.grey.size()) - mean * mean), 15);
    EXPECT_LT(saturated, static_cast<int>(frame.grey.size()) / 5);
  }
}

TEST(SimulatedSequence, TheRoomIsWalkedAsAsked) {
  EXPECT_GT(room().size(), 700);
  EXPECT_GT(room().path_length(), 14);
  EXPECT_LT(room().path_length(), 20);
  // It returns: some late pose is near the first one.
  double nearest = 1e9;
  for (int i = room().size() / 2; i < room().size(); ++i) {
    nearest =
        std::min(nearest, (room().T_world_camera(i).translation() - room().T_world_camera(0).translation()).norm());
  }
  EXPECT_LT(nearest, 0.5);
  // Sideways motion at once.
  const SE3d motion = room().T_world_camera(0).inverse() * room().T_world_camera(15);
  EXPECT_GT(std::abs(motion.translation().x()), 0.06);
}

TEST(SimulatedSequence, NothingStandsInTheWay) {
  const PinholeIntrinsics narrow{24, 18, 20, 20, 11.5, 8.5};
  for (const SimulatedSequence* sequence : {&room(), &street()}) {
    for (int i = 0; i < sequence->size(); i += 5) {
      const Image<float> depth = sequence->depth(i, narrow);
      for (std::size_t k = 0; k < depth.size(); ++k) {
        const float nearest = sequence == &room() ? 0.4f : 1.4f;
        ASSERT_TRUE(depth.data()[k] == 0 || depth.data()[k] > nearest) << sequence->name() << i;
      }
    }
  }
}

TEST(SimulatedSequence, ExposureScalesTheIrradiance) {
  SequenceRecipe recipe = small("room");
  recipe.texel_scale = 4;
  recipe.scale = 0.3;
  const SimulatedSequence constant = make_sequence(recipe, &pool());
  recipe.sensor.exposure_changes = true;
  const SimulatedSequence changing = make_sequence(recipe, &pool());
  double low = 1e9, high = 0;
  for (int i = 0; i < changing.size(); ++i) {
    low = std::min(low, changing.exposure_ms(i));
    high = std::max(high, changing.exposure_ms(i));
    EXPECT_EQ(constant.exposure_ms(i), recipe.sensor.exposure_ms);
    EXPECT_NEAR(changing.exposure_ms(i) / changing.exposure_ms(std::max(i - 1, 0)), 1, 0.05);
  }
  EXPECT_GT(high / low, 1.1);
  const double ratio = changing.exposure_ms(50) / recipe.sensor.exposure_ms;
  EXPECT_NEAR(changing.irradiance(50)(100, 100) / constant.irradiance(50)(100, 100), ratio, 1e-4);
}

TEST(SimulatedSequence, RollingShutterTakesRowsAtTheirTimes) {
  SequenceRecipe recipe = small("room");
  recipe.texel_scale = 4;
  recipe.scale = 0.3;
  recipe.fps = 1000;  // Frame i is taken at i ms: gives the pose of each row.
  const SimulatedSequence global = make_sequence(recipe, &pool());
  recipe.sensor.rolling_shutter_ms = 20;
  const SimulatedSequence rolling = make_sequence(recipe, &pool());
  const Image<float> image = rolling.irradiance(500);
  for (const int row : {10, 120, 230}) {
    const double offset = 20 * ((row + 0.5) / 240 - 0.5);
    const Image<float> same_time = global.irradiance(500 + static_cast<int>(std::lround(offset)));
    const Image<float> frame_time = global.irradiance(500);
    double error = 0, without = 0;
    for (int u = 0; u < 320; ++u) {
      error += std::abs(image(u, row) - same_time(u, row));
      without += std::abs(image(u, row) - frame_time(u, row));
    }
    EXPECT_LT(error / 320, 0.5) << row;
    EXPECT_TRUE(row == 120 || without > 2 * error) << row;
  }
}

TEST(SimulatedSequence, MotionBlurAveragesOverTheExposure) {
  SequenceRecipe recipe = small("room");
  recipe.texel_scale = 4;
  recipe.scale = 0.3;
  recipe.sensor.exposure_ms = 30;
  const SimulatedSequence sharp = make_sequence(recipe, &pool());
  recipe.sensor.motion_blur = true;
  const SimulatedSequence blurred = make_sequence(recipe, &pool());
  const auto roughness = [](const Image<float>& image) {
    double sum = 0;
    for (int v = 0; v < image.height(); ++v) {
      for (int u = 1; u < image.width(); ++u) sum += std::pow(image(u, v) - image(u - 1, v), 2);
    }
    return sum;
  };
  const Image<float> a = sharp.irradiance(100, &pool()), b = blurred.irradiance(100, &pool());
  EXPECT_LT(roughness(b), 0.85 * roughness(a));
}

TEST(SimulatedSequence, WithholdsWhatIsToBeWithheld) {
  SequenceRecipe recipe = small("room");
  recipe.texel_scale = 6;
  recipe.frames = 5;
  recipe.provide_calibration = recipe.provide_exposure = false;
  const SimulatedSequence sequence = make_sequence(recipe, &pool());
  EXPECT_EQ(sequence.size(), 5);
  EXPECT_FALSE(sequence.calibration().photometric.inverse_response.has_value());
  EXPECT_TRUE(sequence.calibration().photometric.vignette.empty());
  EXPECT_FALSE(sequence.render(2).exposure_ms.has_value());
  // The camera has a response all the same: its images are others than those of a linear one.
  recipe.sensor.response = false;
  const Image<float> image = sequence.render(2).grey, linear = make_sequence(recipe, &pool()).render(2).grey;
  EXPECT_FALSE(std::equal(image.data(), image.data() + image.size(), linear.data()));
}

TEST(SequenceRecipe, RefusesNonsense) {
  SequenceRecipe recipe;
  recipe.world = "moon";
  EXPECT_THROW(make_sequence(recipe, nullptr), Error);
  recipe = {};
  recipe.lens = "monocle";
  EXPECT_THROW(make_sequence(recipe, nullptr), Error);
  recipe = {};
  recipe.scale = 0;
  EXPECT_THROW(make_sequence(recipe, nullptr), Error);
  recipe = {};
  recipe.trajectory = "nowhere.txt";
  EXPECT_THROW(make_sequence(recipe, nullptr), Error);
}

}  // namespace
}  // namespace ldso::simulation
