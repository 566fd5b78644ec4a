#pragma once

// Whether a frame shows, at the pose that was found for it, what the reference shows: the contrast across the edges
// of the reference is looked for where these edges fall into the frame. Alignment alone cannot tell. It has two
// parameters of brightness, and explains an image without any structure by a contrast of nothing, or one of another
// place by whatever lies near.

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "odometry/tracking/alignment_kernels.h"

namespace ldso {

struct StructureAgreement {
  /// Correlation of the contrasts, -1 to 1: close to 1 if the frame shows the same surfaces, whatever its exposure;
  /// close to 0 if it shows others, or none.
  double correlation = 0;
  int edges = 0;  ///< That it was taken from: those in view of both.
};

/// `points`: of a level of the reference, with their inverse depths; `reference`, `image`: that level of both images;
/// `camera`: of that level.
StructureAgreement structure_agreement(const AlignmentPoints& points, const ImageView<const Texel>& reference,
                                       const ImageView<const Texel>& image, const PinholeIntrinsics& camera,
                                       const SE3d& T_image_reference);

/// Whether there is anything to be seen: black, white and covered lenses show but noise. `image`: a coarse level, on
/// which noise has been averaged out.
bool has_structure(const ImageView<const Texel>& image);

}  // namespace ldso
