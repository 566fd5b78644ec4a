#pragma once
// The centroid of a disk's image is not the image of its centre: perspective and distortion draw it towards what is
// larger. (J. Heikkila, "Geometric camera calibration using circular control points", PAMI 2000.)

#include <vector>

#include "calibration/lens/lens_adjustment.h"
#include "calibration/lens/lens_calibration.h"

namespace ldso {

/// Radius of the board's disks [m] as the areas in the images have it: prints differ.
double disk_radius(const std::vector<const BoardView*>& views, const Board& board, const LensAndPoses& estimate);

/// Sets the pixels of `observed` to where the centres of the disks are seen whose centroids `view` holds. Points of
/// `observed` are known by their place on the board.
void move_to_centres(const BoardView& view, const Board& board, double radius, const Lens& lens, const SE3d& pose,
                     ObservedView& observed);

}  // namespace ldso
