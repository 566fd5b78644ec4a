#pragma once

// The inverse depths of a run on a simulated sequence compared with the truth: by how many of their standard deviations
// they are wrong.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "ldso/slam.h"
#include "simulation/sequences/simulated_sequence.h"
#include "util/median.h"

namespace ldso::test {

struct DepthErrors {
  int keyframes = 0;
  std::vector<double> squared;   ///< Of each point, in standard deviations.
  std::vector<double> relative;  ///< Of each point: size of the error over the inverse depth.

  double median_squared() const { return squared.empty() ? NAN : median_of(squared); }
  double median_relative() const { return relative.empty() ? NAN : median_of(relative); }

  /// Mean over those within `limit` standard deviations, and their share.
  double mean_squared_of_inliers(double limit) const {
    double sum = 0;
    int count = 0;
    for (const double s : squared) {
      if (!(s < limit * limit)) continue;
      sum += s;
      ++count;
    }
    return count > 0 ? sum / count : NAN;
  }
  double inlier_share(double limit) const {
    const auto count = std::count_if(squared.begin(), squared.end(), [&](double s) { return s < limit * limit; });
    return static_cast<double>(count) / static_cast<double>(squared.size());
  }
};

/// Adds the points of one keyframe. The map's unit about it is found from the points themselves: their median.
inline void add_keyframe_errors(const KeyframeUpdate& keyframe, const Image<float>& depth, DepthErrors& errors) {
  constexpr std::size_t kLeastPoints = 30;
  struct Pair {
    double estimate, truth, stddev;
  };
  std::vector<Pair> pairs;
  std::vector<double> ratios;
  for (const MapPoint& point : keyframe.points) {
    const float z = depth(static_cast<int>(std::lround(point.u)), static_cast<int>(std::lround(point.v)));
    if (!(z > 0) || !(point.idepth > 0)) continue;
    pairs.push_back({point.idepth, 1.0 / z, point.idepth_stddev});
    ratios.push_back(point.idepth * z);
  }
  if (pairs.size() < kLeastPoints) return;
  const double unit = median_of(ratios);
  ++errors.keyframes;
  for (const Pair& pair : pairs) {
    const double error = pair.estimate - unit * pair.truth;
    errors.squared.push_back(error * error / (pair.stddev * pair.stddev));
    errors.relative.push_back(std::abs(error) / (unit * pair.truth));
  }
}

/// Of all keyframes of a run over the first `frames` of a sequence.
inline DepthErrors depth_errors(const simulation::SimulatedSequence& sequence, const Settings& settings, int frames,
                                ThreadPool& pool) {
  Slam slam(sequence.calibration(), settings);
  for (int i = 0; i < std::min(frames, sequence.size()); ++i) {
    const RawFrame raw = sequence.render(i, &pool);
    slam.process(raw.grey.view(), raw.timestamp, raw.exposure_ms);
  }
  const PinholeIntrinsics camera = slam.rectified_camera();
  const SlamResult result = slam.finish();
  DepthErrors errors;
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    add_keyframe_errors(keyframe, sequence.depth(static_cast<int>(keyframe.frame_id), camera, &pool), errors);
  }
  return errors;
}

}  // namespace ldso::test
