#include "io/calibration/calibration_doubts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "geometry/camera_model.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// Of the image size, from its middle: lenses are mounted better.
constexpr double kFarthestCentre = 0.25;

/// Between fx and fy: pixels are square.
constexpr double kMostAnisotropy = 0.2;

/// Fields of view of perspective cameras [deg].
constexpr double kWidestView = 170;
constexpr double kNarrowestView = 3;

/// Relative focal lengths are about 1, absolute ones some hundreds of pixels.
constexpr double kLargestRelative = 10;

/// Focal length of a lens that is told from none, in image widths: a fisheye of 180 degrees has 0.3.
constexpr double kSmallestFocal = 0.05;

/// Share of the image without a ray that is worth a warning, and points along each side that are tried.
constexpr double kFoldedShare = 0.005;
constexpr int kSamples = 32;

std::string understood(const CameraCalibration& c) {
  return format_text("understood: fx %g, fy %g, cx %g, cy %g px of %dx%d", c.fx, c.fy, c.cx, c.cy, c.width, c.height);
}

bool differ(double a, double b) { return std::abs(a - b) > kMostAnisotropy * std::max(a, b); }

double off_centre(double centre, int size) { return std::abs((centre + 0.5) / size - 0.5); }

/// `fx cx fy cy` read as `fx fy cx cy`: the second number is a centre then, the third a focal length.
bool is_other_order(const CameraCalibration& c) {
  return differ(c.fx, c.fy) && !differ(c.fx, c.cx) && off_centre(c.fy, c.width) < kFarthestCentre / 2 &&
         off_centre(c.cy, c.height) < kFarthestCentre / 2 && off_centre(c.cx, c.width) > kFarthestCentre / 2;
}

void doubt_centre(const CameraCalibration& c, const std::string& where, std::vector<std::string>& warnings) {
  const double x = off_centre(c.cx, c.width);
  const double y = off_centre(c.cy, c.height);
  const std::string likely = "are these the intrinsics of images of another size, or numbers in another order?";
  if (x > 0.5 || y > 0.5) throw Error(where, "the principal point is outside of the image; " + understood(c), likely);
  if (std::max(x, y) <= kFarthestCentre) return;
  warnings.push_back(where + ": the principal point is " + format_text("%.0f", 100 * std::max(x, y)) +
                     " % of the image size away from its middle; " + understood(c) + "; " + likely);
}

/// Angle between the rays of both ends of the middle row [deg]; nothing if one has no ray.
std::optional<double> view_deg(const CameraModel& model) {
  const CameraCalibration& c = model.calibration();
  const auto left = model.unproject({-0.5, c.cy});
  const auto right = model.unproject({c.width - 0.5, c.cy});
  if (!left || !right) return std::nullopt;
  return std::acos(std::clamp(left->normalized().dot(right->normalized()), -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool is_fisheye(const CameraCalibration& c) {
  return c.model != CameraModelKind::kPinhole && c.model != CameraModelKind::kRadTan;
}

void doubt_view(const CameraModel& model, const std::string& where, std::vector<std::string>& warnings) {
  const CameraCalibration& c = model.calibration();
  // Far inside of the image every camera sees something; not so one whose focal length is in millimetres.
  const bool blind = !model.unproject({c.cx + 0.2 * c.width, c.cy}) || !model.unproject({c.cx, c.cy + 0.2 * c.height});
  const std::optional<double> view = view_deg(model);
  if (blind || (view && *view > kWidestView && !is_fisheye(c))) {
    throw Error(where,
                blind ? "there is no ray for pixels well inside of the image; " + understood(c)
                      : format_text("the field of view would be %.0f degrees; ", *view) + understood(c),
                "is the focal length in millimetres, or are the distortion coefficients in another order?");
  }
  if (!view || *view >= kNarrowestView) return;
  warnings.push_back(where + format_text(": the field of view is only %.2f degrees; ", *view) + understood(c) +
                     "; are these the intrinsics of larger images, of a photo for a video for instance?");
}

/// Share of the image whose pixels have no ray.
double share_without_ray(const CameraModel& model) {
  const CameraCalibration& c = model.calibration();
  int without = 0;
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; j <= kSamples; ++j) {
      const double x = (c.width - 1) * i / double{kSamples};
      const double y = (c.height - 1) * j / double{kSamples};
      if (!model.unproject({x, y})) ++without;
    }
  }
  return without / double{(kSamples + 1) * (kSamples + 1)};
}

void doubt_distortion(const CameraModel& model, const std::string& where, std::vector<std::string>& warnings) {
  const CameraCalibration& c = model.calibration();
  if (c.model != CameraModelKind::kRadTan) return;  // A fisheye may well see what is behind it.
  const double share = share_without_ray(model);
  if (share < kFoldedShare) return;
  warnings.push_back(where + ": the distortion folds over inside of the image, " + format_text("%.0f", 100 * share) +
                     " % of which have no ray and are not used; " + understood(c) +
                     format_text(", k1 %g, k2 %g", c.distortion[0], c.distortion[1]) +
                     "; `k1 k2 p1 p2` is the order, and the calibration has to reach the corners");
}

}  // namespace

void doubt_mixed_units(double fx, double fy, double cx, double cy, const std::string& where) {
  const std::string numbers = format_text("fx %g, fy %g, cx %g, cy %g", fx, fy, cx, cy);
  const std::string remedy = "write all four in pixels, or all four relative to the image size";
  const auto is_relative = [](double centre) { return centre > 0 && centre < 1; };
  if (is_relative(cx) != is_relative(cy) && std::max(cx, cy) >= 2 && std::min(cx, cy) > 0)
    throw Error(where, "one coordinate of the centre is relative to the image size and the other is not: " + numbers,
                remedy);
  const bool centre = is_relative(cx) && is_relative(cy);
  if (centre && std::max(fx, fy) > kLargestRelative)
    throw Error(where, "the centre is relative to the image size, but the focal lengths are not: " + numbers, remedy);
}

void doubt_intrinsics(const CameraCalibration& camera, const std::string& where, std::vector<std::string>& warnings) {
  const double focal = std::max(camera.fx, camera.fy);
  if (focal < kLargestRelative && focal < kSmallestFocal * camera.width) {
    throw Error(
        where,
        "the focal lengths are relative to the image size or in millimetres, the centre is not; " + understood(camera),
        "write all four in pixels, or all four relative to the image size");
  }
  if (is_other_order(camera))
    throw Error(where, "the numbers look like `fx cx fy cy`; " + understood(camera), "`fx fy cx cy` is the order");
  doubt_centre(camera, where, warnings);
  if (differ(camera.fx, camera.fy)) {
    warnings.push_back(where + ": fx and fy differ by more than 20 %; " + understood(camera) +
                       "; `fx fy cx cy` is the order, and pixels are square as a rule");
  }
  const std::unique_ptr<CameraModel> model = make_camera_model(camera);
  doubt_view(*model, where, warnings);
  doubt_distortion(*model, where, warnings);
}

}  // namespace ldso
