#pragma once
// How much the scale of a monocular estimate changes on the way: the first third of the pairs against the last.

#include <optional>

#include "evaluation/association.h"

namespace ldso {

/// Each scale is the factor of the Umeyama Sim(3) that maps a third of the estimate to the ground truth.
struct ScaleDrift {
  double first_scale = 1;
  double last_scale = 1;
  double ratio = 1;  ///< last / first: above 1, the estimate shrank on its way.
  double drift = 1;  ///< max(ratio, 1 / ratio), so that shrinking and growing count alike and 1 is perfect.
};

/// Empty if there are fewer than 9 pairs or the camera stands still in a third (its scale cannot be told).
std::optional<ScaleDrift> scale_drift(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs);

}  // namespace ldso
