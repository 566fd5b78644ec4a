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

/// What is compared: one pyramid level of both images.
struct StructureComparison {
  const AlignmentPoints& points;  ///< Of the reference, with their inverse depths.
  ImageView<const Texel> reference, image;
  PinholeIntrinsics camera;
  SE3d T_image_reference;
};

StructureAgreement structure_agreement(const StructureComparison& comparison);

/// Share of the image, by its cells, in which what is seen agrees with the reference, 0 to 1. Noise agrees nowhere,
/// though it is explained by any motion.
double agreeing_share(const StructureComparison& comparison);

}  // namespace ldso
