#pragma once

// A drive in laps with an odometry that drifts, for the tests and the benchmark of the pose graph.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "geometry/umeyama.h"
#include "mapping/graph/pose_graph.h"

namespace ldso {

struct PoseGraphSceneSettings {
  int keyframes = 400;
  int keyframes_per_lap = 150;
  int edges_per_keyframe = 5;  ///< To as many predecessors.
  double radius = 20;
  /// Standard deviations of the odometry's random walk, a keyframe.
  double translation = 0.01, rotation = 0.002, log_scale = 0.003;
  /// The information claims this much smaller ones.
  double overconfidence = 1;
  double loop_translation = 0.05, loop_rotation = 0.01, loop_log_scale = 0.02;
  unsigned seed = 1;
};

/// The edges of a keyframe come from the same odometry and agree, as those of a sliding window do.
class PoseGraphScene {
 public:
  explicit PoseGraphScene(const PoseGraphSceneSettings& scene_settings = {})
      : settings(scene_settings), random_(scene_settings.seed) {
    for (int i = 0; i < settings.keyframes; ++i) truth.push_back(true_pose(i));
    odometry.push_back(truth[0]);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      const Sim3d step =
          noise(settings.translation, settings.rotation, settings.log_scale) * truth[i - 1].inverse() * truth[i];
      odometry.push_back(odometry[i - 1] * step);
    }
  }

  static Matrix7d information(double translation, double rotation, double log_scale) {
    Sim3d::Tangent stddev;
    stddev << translation, translation, translation, rotation, rotation, rotation, log_scale;
    return stddev.cwiseAbs2().cwiseInverse().asDiagonal();
  }

  Sim3d noise(double translation, double rotation, double log_scale) {
    Sim3d::Tangent x;
    for (int i = 0; i < 7; ++i) x[i] = normal_(random_) * (i < 3 ? translation : i < 6 ? rotation : log_scale);
    return Sim3d::exp(x);
  }

  void add_odometry(PoseGraph& graph) const {
    for (int i = 0; i < settings.keyframes; ++i) {
      graph.add_keyframe(i, odometry[static_cast<std::size_t>(i)]);
      for (int k = 1; k <= settings.edges_per_keyframe && k <= i; ++k) graph.add_odometry_edge(odometry_edge(i - k, i));
    }
  }

  PoseGraphEdge odometry_edge(int from, int to) const {
    // n edges to the n predecessors, each of the variance of the random walk, would together have n (n + 1) / 2 times
    // its information.
    const double n = settings.edges_per_keyframe;
    const double growth = std::sqrt((to - from) * n * (n + 1) / 2) / settings.overconfidence;
    return {from, to, at(odometry, from).inverse() * at(odometry, to),
            information(growth * settings.translation, growth * settings.rotation, growth * settings.log_scale)};
  }

  PoseGraphEdge true_loop(int from, int to) {
    const Sim3d error = noise(settings.loop_translation, settings.loop_rotation, settings.loop_log_scale);
    return {from, to, error * at(truth, from).inverse() * at(truth, to), loop_information()};
  }

  /// Claims that both keyframes are at the same place.
  PoseGraphEdge wrong_loop(int from, int to) { return {from, to, noise(0.3, 0.05, 0.02), loop_information()}; }

  Matrix7d loop_information() const {
    return information(settings.loop_translation, settings.loop_rotation, settings.loop_log_scale);
  }

  /// Root mean square error of the positions after alignment with the truth.
  double error(const PoseGraph& graph) const {
    std::vector<Eigen::Vector3d> estimated, true_positions;
    for (int i = 0; i < settings.keyframes; ++i) {
      estimated.push_back(graph.S_world_keyframe(i).translation());
      true_positions.push_back(at(truth, i).translation());
    }
    const Sim3d S = umeyama(estimated, true_positions, AlignmentMode::kSim3);
    double sum = 0;
    for (std::size_t i = 0; i < estimated.size(); ++i) sum += (S * estimated[i] - true_positions[i]).squaredNorm();
    return std::sqrt(sum / settings.keyframes);
  }

  static const Sim3d& at(const std::vector<Sim3d>& poses, int i) { return poses[static_cast<std::size_t>(i)]; }

  PoseGraphSceneSettings settings;
  std::vector<Sim3d> truth, odometry;

 private:
  /// A circle with waves up and down, looking ahead.
  Sim3d true_pose(int i) const {
    const double angle = 2 * 3.14159265358979 * i / settings.keyframes_per_lap;
    const Eigen::Vector3d position(settings.radius * std::sin(angle), std::sin(3 * angle),
                                   settings.radius * std::cos(angle));
    return Sim3d(SO3d::exp({0, angle, 0}) * SO3d::exp({0.1 * std::cos(3 * angle), 1.57, 0}), position, 1);
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace ldso
