#pragma once

// Finds a lost camera in the keyframes of the window: their corners, which the window's points give depth, are
// recognized in the image on several scales, and the pose that most of them agree on is where the alignment begins.
// Places that have left the window are the business of loop closing.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "ldso/loop_settings.h"
#include "odometry/tracking/pose_finder.h"
#include "place/scaled_features.h"

namespace ldso {

/// A described corner of a keyframe and where it is.
struct Landmark {
  ScaledFeature feature;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< In the world.
};

/// A landmark and the feature of an image that looks like it.
struct LandmarkMatch {
  int landmark = 0;
  int feature = 0;
  int bits = 0;  ///< In which their descriptors differ.
};

class WindowRelocalizer : public PoseFinder {
 public:
  WindowRelocalizer(const LoopMatchingSettings& matching, const PnpSettings& pnp) : matching_(matching), pnp_(pnp) {}

  std::optional<FoundPose> find(const Window& window, const PreparedFrame& frame) override;

 private:
  LoopMatchingSettings matching_;
  PnpSettings pnp_;
  std::optional<std::int64_t> newest_;  ///< Keyframe of the window whose landmarks these are.
  std::vector<Landmark> landmarks_;
};

/// For each landmark the most similar of `features`, if it is unlike those elsewhere in the image; for each feature the
/// most similar landmark that wants it. Of those, the ones that are turned like most, if that is no more than a camera
/// rolls. Ordered by feature.
std::vector<LandmarkMatch> match_landmarks(const std::vector<Landmark>& landmarks,
                                           const std::vector<ScaledFeature>& features,
                                           const LoopMatchingSettings& settings = {});

}  // namespace ldso
