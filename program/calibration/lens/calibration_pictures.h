#pragma once
// Where in the image the points of a calibration are, and how they are off.

#include "calibration/lens/lens_calibration.h"
#include "io/images/image_file.h"

namespace ldso {

/// Every point as a dot, green where it fits and red where it is off by three times the usual distance; the thirds of
/// the image.
Image<Rgb> draw_coverage(const LensCalibration& lens);

/// The mean residual of each cell of the image as an arrow, enlarged as the picture says. Arrows that agree with their
/// neighbours are what the model does not explain; those in all directions are noise.
Image<Rgb> draw_residuals(const LensCalibration& lens);

}  // namespace ldso
