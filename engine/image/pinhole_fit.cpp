#include "image/pinhole_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Where errors say that they come from.
constexpr char kContext[] = "rectification";
/// Columns on each side of the centre among which the largest rectangle is searched: less than a pixel apart in images
/// of up to a thousand.
constexpr int kColumns = 512;
/// Steps in which the border of the visible region is approached, of tan(angle to the optical axis): no gap in what a
/// lens sees is narrower.
constexpr double kStep = 0.01;
/// Bisections of such a step: down to 1e-14.
constexpr int kBisections = 40;
/// Steps by which a rectangle shrinks whose border is not visible yet, of its pixels.
constexpr double kShrinkStep = 0.05;
/// Such steps at most, 20 pixels in all: what needs more is no rectangle inside of the image.
constexpr int kMostShrinkSteps = 400;
/// Spacing of the grid inside of the image that finds where a camera model ends [px].
constexpr int kGrid = 8;

struct Size {
  int width = 0;
  int height = 0;
};

std::string to_string(const Size& size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// A rectangle on the plane z = 1, through the centres of the outermost pixels.
struct PlaneBox {
  double left = 0, right = 0, top = 0, bottom = 0;
};

PinholeIntrinsics intrinsics_of(const PlaneBox& box, const Size& size) {
  PinholeIntrinsics result;
  result.width = size.width;
  result.height = size.height;
  result.fx = (size.width - 1) / (box.right - box.left);
  result.fy = (size.height - 1) / (box.bottom - box.top);
  result.cx = -box.left * result.fx;
  result.cy = -box.top * result.fy;
  return result;
}

Size output_size(const CameraCalibration& camera, const Rectification& wanted) {
  Size size{wanted.width, wanted.height};
  if (wanted.mode == RectificationMode::kExplicit && size.width == 0 && size.height == 0) {
    size = {wanted.explicit_intrinsics.width, wanted.explicit_intrinsics.height};
  }
  if (size.width == 0) size.width = camera.width;
  if (size.height == 0) size.height = camera.height;
  if (size.width < 2 || size.height < 2) {
    throw Error(kContext, "output size " + to_string(size), "give at least 2 x 2 pixels, or 0 for the input size");
  }
  return size;
}

PinholeIntrinsics unchanged(const CameraCalibration& camera, const Size& size) {
  if (!is_pinhole(camera)) {
    throw Error(kContext, "mode 'none' needs a pinhole camera but the camera model has distortion",
                "use crop, full or explicit output intrinsics");
  }
  if (size.width != camera.width || size.height != camera.height) {
    throw Error(kContext,
                "mode 'none' cannot change the size from " + to_string({camera.width, camera.height}) + " to " +
                    to_string(size),
                "make the output size equal to the input size, or use crop");
  }
  return {camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy};
}

PinholeIntrinsics explicit_camera(const PinholeIntrinsics& given, const Size& size) {
  PinholeIntrinsics result = given;
  result.width = size.width;
  result.height = size.height;
  const bool finite =
      std::isfinite(given.fx) && std::isfinite(given.fy) && std::isfinite(given.cx) && std::isfinite(given.cy);
  if (!finite || !(given.fx > 0) || !(given.fy > 0)) {
    throw Error(kContext,
                "explicit intrinsics fx " + std::to_string(given.fx) + " fy " + std::to_string(given.fy) + " cx " +
                    std::to_string(given.cx) + " cy " + std::to_string(given.cy),
                "all have to be finite and the focal lengths above 0 [px]");
  }
  return result;
}

// Without distortion the whole input is the largest and the smallest rectangle alike.
PinholeIntrinsics resized(const CameraCalibration& camera, const Size& size) {
  if (size.width == camera.width && size.height == camera.height) return unchanged(camera, size);
  const PlaneBox box{-camera.cx / camera.fx, (camera.width - 1 - camera.cx) / camera.fx, -camera.cy / camera.fy,
                     (camera.height - 1 - camera.cy) / camera.fy};
  return intrinsics_of(box, size);
}

// --- crop -------------------------------------------------------------------------------------------------------

/// How far one can walk from `start` (visible) in `direction` (unit length) and stay visible, up to `limit`.
double visible_length(const VisibleRegion& region, const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                      double step, double limit) {
  double inside = 0;
  double outside = step;
  while (outside < limit && region.contains(start + outside * direction)) {
    inside = outside;
    outside += step;
  }
  outside = std::min(outside, limit);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (inside + outside);
    (region.contains(start + middle * direction) ? inside : outside) = middle;
  }
  return inside;
}

/// Columns of the visible region from the centre outward on one side, each with what is visible above and below
/// in it and in all columns before it.
struct SideProfile {
  std::vector<double> x, top, bottom;
};

SideProfile side_profile(const VisibleRegion& region, const Eigen::Vector2d& centre, double sign) {
  const double limit = VisibleRegion::kMaxTangent;
  const double reach = visible_length(region, centre, {sign, 0}, kStep, limit - sign * centre.x());
  SideProfile profile;
  double top = -limit;
  double bottom = limit;
  for (int i = 0; i <= kColumns; ++i) {
    const Eigen::Vector2d start = centre + Eigen::Vector2d(sign * reach * i / kColumns, 0);
    top = std::max(top, start.y() - visible_length(region, start, {0, -1}, kStep, limit + centre.y()));
    bottom = std::min(bottom, start.y() + visible_length(region, start, {0, 1}, kStep, limit - centre.y()));
    profile.x.push_back(start.x());
    profile.top.push_back(top);
    profile.bottom.push_back(bottom);
  }
  return profile;
}

/// Tries every pair of a left and a right column: the height follows from the columns between them.
PlaneBox largest_box(const SideProfile& left, const SideProfile& right) {
  PlaneBox best;
  double best_area = 0;
  for (std::size_t i = 0; i < left.x.size(); ++i) {
    for (std::size_t j = 0; j < right.x.size(); ++j) {
      const double top = std::max(left.top[i], right.top[j]);
      const double bottom = std::min(left.bottom[i], right.bottom[j]);
      const double area = (right.x[j] - left.x[i]) * (bottom - top);
      if (area <= best_area) continue;
      best_area = area;
      best = {left.x[i], right.x[j], top, bottom};
    }
  }
  return best;
}

bool is_line_visible(const VisibleRegion& region, const Eigen::Vector2d& from, const Eigen::Vector2d& to, int pixels) {
  for (int i = 0; i < pixels; ++i) {
    const double t = static_cast<double>(i) / (pixels - 1);
    if (!region.contains((1 - t) * from + t * to)) return false;
  }
  return true;
}

/// Moves every side inward by a part of a pixel until all pixels of the border are visible: the search looked at
/// a finite number of columns only.
PlaneBox shrink_to_visible(const VisibleRegion& region, PlaneBox box, const Size& size) {
  const double step_x = kShrinkStep * (box.right - box.left) / size.width;
  const double step_y = kShrinkStep * (box.bottom - box.top) / size.height;
  for (int attempt = 0; attempt < kMostShrinkSteps; ++attempt) {
    const Eigen::Vector2d upper_left(box.left, box.top), upper_right(box.right, box.top);
    const Eigen::Vector2d lower_left(box.left, box.bottom), lower_right(box.right, box.bottom);
    const bool left = is_line_visible(region, upper_left, lower_left, size.height);
    const bool right = is_line_visible(region, upper_right, lower_right, size.height);
    const bool top = is_line_visible(region, upper_left, upper_right, size.width);
    const bool bottom = is_line_visible(region, lower_left, lower_right, size.width);
    if (left && right && top && bottom) return box;
    if (!left) box.left += step_x;
    if (!right) box.right -= step_x;
    if (!top) box.top += step_y;
    if (!bottom) box.bottom -= step_y;
  }
  throw Error(kContext, "found no rectangle all of whose pixels are inside of the image",
              "check the camera model and its coefficients, or give explicit output intrinsics");
}

PinholeIntrinsics crop(const VisibleRegion& region, const Size& size) {
  const Eigen::Vector2d middle(0.5 * (region.input_width() - 1), 0.5 * (region.input_height() - 1));
  const std::optional<Eigen::Vector2d> centre = region.point(middle);
  if (!centre || !region.contains(*centre)) {
    throw Error(kContext, "the camera model does not see the middle of the image",
                "check the camera model, its coefficients and the image size");
  }
  const PlaneBox box = largest_box(side_profile(region, *centre, -1), side_profile(region, *centre, 1));
  if (!(box.right > box.left) || !(box.bottom > box.top)) {
    throw Error(kContext, "the visible region around the middle of the image is empty",
                "check the camera model, its coefficients and the image size");
  }
  return intrinsics_of(shrink_to_visible(region, box, size), size);
}

// --- full -------------------------------------------------------------------------------------------------------

void extend(PlaneBox& box, const VisibleRegion& region, double x, double y) {
  const std::optional<Eigen::Vector2d> point = region.point({x, y});
  if (!point) return;
  box.left = std::min(box.left, point->x());
  box.right = std::max(box.right, point->x());
  box.top = std::min(box.top, point->y());
  box.bottom = std::max(box.bottom, point->y());
}

/// The border of the input decides, except where the model ends inside of the image: hence the grid.
PlaneBox bounding_box(const VisibleRegion& region) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PlaneBox box{kInfinity, -kInfinity, kInfinity, -kInfinity};
  const int last_x = region.input_width() - 1;
  const int last_y = region.input_height() - 1;
  for (int x = 0; x <= last_x; ++x) {
    extend(box, region, x, 0);
    extend(box, region, x, last_y);
  }
  for (int y = 0; y <= last_y; ++y) {
    extend(box, region, 0, y);
    extend(box, region, last_x, y);
  }
  for (int y = 0; y <= last_y; y += kGrid) {
    for (int x = 0; x <= last_x; x += kGrid) extend(box, region, x, y);
  }
  return box;
}

PinholeIntrinsics full(const VisibleRegion& region, const Size& size) {
  const PlaneBox box = bounding_box(region);
  const double limit = VisibleRegion::kMaxTangent;
  const bool fits = box.right > box.left && box.bottom > box.top && box.left >= -limit && box.right <= limit &&
                    box.top >= -limit && box.bottom <= limit;
  if (!fits) {
    throw Error(kContext, "mode 'full' cannot show this lens in a pinhole image: it sees more than 80 degrees off axis",
                "use crop or explicit output intrinsics");
  }
  return intrinsics_of(box, size);
}

}  // namespace

bool is_pinhole(const CameraCalibration& camera) {
  const auto is_zero = [](double coefficient) { return coefficient == 0; };
  switch (camera.model) {
    case CameraModelKind::kPinhole:
      return true;
    case CameraModelKind::kFov:
      return camera.distortion[0] == 0;
    case CameraModelKind::kRadTan:
      return std::all_of(camera.distortion.begin(), camera.distortion.end(), is_zero) &&
             std::all_of(camera.more_distortion.begin(), camera.more_distortion.end(), is_zero);
    case CameraModelKind::kKannalaBrandt:
      return false;  // equidistant even with zeros
    case CameraModelKind::kDoubleSphere:
    case CameraModelKind::kEucm:
      return false;  // nobody calibrates these to be a pinhole
  }
  return false;
}

PinholeIntrinsics fit_pinhole(const CameraCalibration& camera, const Rectification& rectification,
                              const VisibleRegion& region) {
  const Size size = output_size(camera, rectification);
  switch (rectification.mode) {
    case RectificationMode::kNone:
      return unchanged(camera, size);
    case RectificationMode::kExplicit:
      return explicit_camera(rectification.explicit_intrinsics, size);
    case RectificationMode::kCrop:
      return is_pinhole(camera) ? resized(camera, size) : crop(region, size);
    case RectificationMode::kFull:
      return is_pinhole(camera) ? resized(camera, size) : full(region, size);
  }
  throw Error(kContext, "unknown mode", "use none, crop, full or explicit");
}

}  // namespace ldso
