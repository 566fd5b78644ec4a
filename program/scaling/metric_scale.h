#pragma once
// The scale of a single camera is free. One known length makes it metric: a distance that the camera has covered, a
// tag of known size, the camera's height above the ground it drives on.

#include <optional>
#include <string>
#include <vector>

#include "io/images/april_tag.h"
#include "ldso/io/dataset.h"
#include "ldso/slam.h"

namespace ldso {

/// Between the camera's positions at two frames (numbers in the sequence as it is played).
struct KnownDistance {
  int frame_a = 0, frame_b = 0;
  double metres = 0;
};

struct KnownHeight {
  double metres = 0;  ///< Of the camera's centre above the ground.
};

/// At most one of them.
struct ScaleRequest {
  std::optional<KnownDistance> distance;
  std::optional<AprilTag> tag;  ///< Anywhere in the sequence.
  std::optional<KnownHeight> height;

  bool is_empty() const { return !distance && !tag && !height; }
};

/// What a known length says of the unit of a map.
struct ScaleEstimate {
  std::string source;                     ///< "tag 36h11:3 of 0.16 m".
  double metres_per_unit = 1;             ///< 1 if there is a problem.
  std::optional<double> relative_stddev;  ///< Of metres_per_unit, if the images tell it.
  int measurements = 0;                   ///< Images or stretches of the way that it comes from.
  std::optional<double> drift;            ///< Ratio of the scales at the end and the beginning of the way, if known.
  std::string problem;                    ///< Why there is no scale; or empty.
};

/// Throws Error if a frame or a length is impossible for a sequence of `frames` frames (0: nobody knows).
void check_request(const ScaleRequest& request, int frames);

/// `calibration`: what the frames were read with. Frames are read again for tags only.
ScaleEstimate estimate_scale(const ScaleRequest& request, const SlamResult& result, const Calibration& calibration,
                             const Dataset& dataset);

}  // namespace ldso
