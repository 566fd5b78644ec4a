#pragma once

// A world made up for the tests of loop closing: landmarks with descriptors, keyframes that see them, and an odometry
// whose unit, heading and position wander. All errors of features are drawn from the noise that is claimed.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "geometry/pinhole_projection.h"
#include "ldso/calibration.h"
#include "ldso/records.h"
#include "mapping/map/feature_builder.h"
#include "mapping/map/keyframe_map.h"
#include "place/test_descriptors.h"
#include "place/vocabulary.h"

namespace ldso::loop_test {

inline constexpr int kWordCount = 4000;

struct Landmark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  OrbDescriptor descriptor;
  WordId word = 0;
};

inline PinholeIntrinsics camera() { return {640, 480, 400, 400, 319.5, 239.5}; }

/// Words of its own for each of the first kWordCount landmarks.
inline void add_landmark(std::vector<Landmark>& landmarks, const Eigen::Vector3d& position, std::mt19937_64& random) {
  const auto word = static_cast<WordId>(landmarks.size() % kWordCount);
  landmarks.push_back({position, place_test::random_descriptor(random), word});
}

/// In a box.
inline std::vector<Landmark> box_of_landmarks(int count, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                              std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Landmark> landmarks;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d position;
    for (int k = 0; k < 3; ++k) position[k] = low[k] + share(random) * (high[k] - low[k]);
    add_landmark(landmarks, position, random);
  }
  return landmarks;
}

struct SeeingSettings {
  double pixel_sigma = 0.5;
  double relative_depth_sigma = 0.02;
  double depth_share = 0.7;  ///< Of the features.
  int flipped_bits = 10;     ///< Of a descriptor.
  double farthest = 200;     ///< [m]
};

/// What a keyframe sees, in map units of `unit` to the metre.
inline KeyframeFeatures see(const std::vector<Landmark>& landmarks, const SE3d& T_world_camera, double unit,
                            std::uint64_t seed, const SeeingSettings& settings = {}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0, 1);
  KeyframeFeatures result;
  std::set<WordId> words;
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d p = T_world_camera.inverse() * landmark.position;
    if (p.z() < 0.3 || p.z() > settings.farthest) continue;
    Eigen::Vector2d pixel = project(camera(), p);
    for (double& coordinate : pixel) coordinate += settings.pixel_sigma * normal(random);
    if ((pixel.array() < 0).any() || pixel.x() > 639 || pixel.y() > 479) continue;
    MapFeature feature;
    feature.feature.u = static_cast<float>(pixel.x());
    feature.feature.v = static_cast<float>(pixel.y());
    feature.feature.angle = static_cast<float>(0.05 * normal(random));
    feature.feature.descriptor = place_test::flip_bits(landmark.descriptor, settings.flipped_bits, random);
    feature.node = landmark.word % 64;
    const double idepth = 1 / (unit * p.z()), sigma = settings.relative_depth_sigma * idepth;
    const double measured = idepth + sigma * normal(random);
    if (share(random) < settings.depth_share) {
      feature.idepth = static_cast<float>(measured);
      feature.idepth_stddev = static_cast<float>(sigma);
    }
    result.features.push_back(feature);
    words.insert(landmark.word);
  }
  for (const WordId word : words) result.words.emplace_back(word, 1.0f / static_cast<float>(words.size()));
  return result;
}

inline Matrix7d diagonal_covariance(double translation, double rotation, double log_scale) {
  Sim3d::Tangent stddev;
  stddev << translation, translation, translation, rotation, rotation, rotation, log_scale;
  return stddev.cwiseAbs2().asDiagonal();
}

/// A flat vocabulary: loop closing with features that come with their words asks it for no more than their number.
inline Vocabulary flat_vocabulary() {
  std::mt19937_64 random(7);
  std::vector<VocabularyNode> nodes(1);
  for (int i = 0; i < kWordCount; ++i) nodes.push_back({0, 1, place_test::random_descriptor(random)});
  return Vocabulary(nodes);
}

/// A drive and what the odometry makes of it.
struct Drive {
  std::vector<Landmark> landmarks;
  std::vector<SE3d> truth;     ///< T_world_camera [m].
  std::vector<SE3d> odometry;  ///< T_world_camera [map units].
  std::vector<double> unit;    ///< Map units to the metre at each keyframe.
  std::vector<KeyframeUpdate> updates;
  std::vector<KeyframeFeatures> features;
  int size() const { return static_cast<int>(truth.size()); }
};

struct DriftSettings {
  double yaw = 0.004;         ///< [rad] from one keyframe to the next.
  double log_scale = -0.006;  ///< Likewise.
  double translation = 0.01;  ///< Standard deviation [map units], likewise.
  double rotation = 0.001;    ///< Standard deviation [rad], likewise.
};

/// Keyframes at which the odometry lost its way: nothing links them to those before, and it starts again from zero.
using Restarts = std::set<int>;

/// The odometry of `drive.truth`, with constraints of each keyframe to the four after it.
inline void add_odometry(Drive& drive, const DriftSettings& drift, std::uint64_t seed, const Restarts& restarts = {}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  drive.odometry = {drive.truth[0]};
  drive.unit = {1};
  for (int i = 1; i < drive.size(); ++i) {
    SE3d step = drive.truth[i - 1].inverse() * drive.truth[i];
    step.translation() *= drive.unit[i - 1];
    SE3d::Tangent x;
    for (int k = 0; k < 6; ++k) x[k] = normal(random) * (k < 3 ? drift.translation : drift.rotation);
    x[4] += drift.yaw;
    drive.odometry.push_back(restarts.count(i) ? SE3d() : drive.odometry[i - 1] * SE3d::exp(x) * step);
    drive.unit.push_back(drive.unit[i - 1] * std::exp(drift.log_scale));
  }
  for (int i = 0; i < drive.size(); ++i) {
    KeyframeUpdate update;
    update.frame_id = 10 * i;
    update.timestamp = i;
    update.T_world_camera = drive.odometry[i];
    for (int j = i + 1; j <= i + 4 && j < drive.size() && !restarts.count(j); ++j) {
      const double growth = std::sqrt(j - i);
      const Matrix7d covariance = diagonal_covariance(growth * drift.translation, growth * std::abs(drift.yaw),
                                                      growth * std::abs(drift.log_scale));
      update.constraints.push_back({10 * j, drive.odometry[i].inverse() * drive.odometry[j], covariance});
    }
    drive.updates.push_back(update);
  }
}

inline void add_features(Drive& drive, std::uint64_t seed, const SeeingSettings& seeing) {
  for (int i = 0; i < drive.size(); ++i) {
    drive.features.push_back(see(drive.landmarks, drive.truth[i], drive.unit[i], seed + i, seeing));
  }
}

/// The i-th keyframe of a drive in a circle of radius 5 m around `centre` with a wall around it, looking at the wall;
/// 40 keyframes a lap.
inline SE3d circle_pose(double i, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero()) {
  const double angle = 2 * M_PI * i / 40;
  const Eigen::Vector3d position(5 * std::sin(angle), 0.2 * std::sin(3 * angle), 5 * std::cos(angle));
  return SE3d(SO3d::exp({0, angle, 0}), centre + position);
}

/// The wall of circle_pose(): landmarks 8 to 12 m from the centre.
inline std::vector<Landmark> circle_wall(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(0, 2 * M_PI), radius(8, 12), height(-4, 4);
  std::vector<Landmark> landmarks;
  for (int i = 0; i < count; ++i) {
    const double a = angle(random), r = radius(random);
    add_landmark(landmarks, {r * std::sin(a), height(random), r * std::cos(a)}, random);
  }
  return landmarks;
}

/// Round the circle and on over the beginning.
inline Drive circle_drive(int keyframes, std::uint64_t seed, const DriftSettings& drift = {},
                          const Restarts& restarts = {}) {
  SeeingSettings seeing;
  seeing.farthest = 10;
  Drive drive;
  drive.landmarks = circle_wall(1500, seed);
  // Not at the same places again.
  for (int i = 0; i < keyframes; ++i) drive.truth.push_back(circle_pose(i < 40 ? i : i + 0.3));
  add_odometry(drive, drift, seed + 1, restarts);
  add_features(drive, seed + 2, seeing);
  return drive;
}

}  // namespace ldso::loop_test
