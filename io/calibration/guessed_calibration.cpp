#include "io/calibration/guessed_calibration.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "image/working_size.h"

namespace ldso {
namespace {

/// Of phones that film, as a share of the longer side of the image: 65 degrees.
constexpr double kUsualFocal = 0.78;
/// Diagonal of an image on 35 mm film [mm].
constexpr double kFilmDiagonal = 43.267;

}  // namespace

Calibration guess_calibration(int width, int height, std::optional<double> focal_35mm) {
  Calibration guess;
  CameraCalibration& camera = guess.camera;
  const int longer = std::max(width, height);
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_35mm ? *focal_35mm / kFilmDiagonal * std::hypot(width, height) : kUsualFocal * longer;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  guess.source = focal_35mm ? CameraSource::kMetadata : CameraSource::kNone;
  guess.description = focal_35mm ? "no calibration; by the metadata of the images " +
                                       std::to_string(std::lround(*focal_35mm)) + " mm (35 mm equivalent)"
                                 : "no calibration; a guess";
  return with_longest_side(std::move(guess), kGuessedSize);
}

}  // namespace ldso
