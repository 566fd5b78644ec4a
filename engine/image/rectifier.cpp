#include "image/rectifier.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "image/masked_image.h"
#include "image/pinhole_fit.h"
#include "image/pyramid_kernels.h"
#include "image/visible_region.h"

namespace ldso {
namespace {

bool same_camera(const CameraCalibration& camera, const PinholeIntrinsics& pinhole) {
  return is_pinhole(camera) && camera.width == pinhole.width && camera.height == pinhole.height &&
         camera.fx == pinhole.fx && camera.fy == pinhole.fy && camera.cx == pinhole.cx && camera.cy == pinhole.cy;
}

Eigen::Vector2d plane_point(const PinholeIntrinsics& camera, double x, double y) {
  return {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy};
}

/// How often the input can be halved without losing resolution in the middle of the output.
int count_halvings(const VisibleRegion& region, const PinholeIntrinsics& output) {
  const double x = 0.5 * (output.width - 1);
  const double y = 0.5 * (output.height - 1);
  const std::optional<Eigen::Vector2d> centre = region.pixel(plane_point(output, x, y));
  const std::optional<Eigen::Vector2d> right = region.pixel(plane_point(output, x + 1, y));
  const std::optional<Eigen::Vector2d> below = region.pixel(plane_point(output, x, y + 1));
  if (!centre || !right || !below) return 0;
  const double scale = std::min((*right - *centre).norm(), (*below - *centre).norm());
  int halvings = 0;
  const int smaller_side = std::min(region.input_width(), region.input_height());
  while (std::ldexp(1.0, halvings + 1) <= scale && (smaller_side >> (halvings + 1)) >= 2) ++halvings;
  return halvings;
}

/// Pixels of the halved input that surround a coordinate, kept inside.
struct Sample {
  int first;
  float fraction;
};

Sample sample_at(double coordinate, int halvings, int input_size) {
  const int size = input_size >> halvings;
  const double halved = (coordinate + 0.5) * std::ldexp(1.0, -halvings) - 0.5;
  const double inside = std::clamp(halved, 0.0, size - 1.0);
  const int first = std::min(static_cast<int>(inside), size - 2);
  return {first, static_cast<float>(inside - first)};
}

RemapTable make_table(const VisibleRegion& region, const PinholeIntrinsics& output, int halvings,
                      const Displacement& warp) {
  RemapTable table;
  table.width = output.width;
  table.height = output.height;
  const std::size_t count = static_cast<std::size_t>(output.width) * output.height;
  table.offset.assign(count, 0);
  table.fraction_x.assign(count, -1.0f);
  table.fraction_y.assign(count, 0.0f);
  const int stride = region.input_width() >> halvings;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const Eigen::Vector2d from = warp ? warp({x, y}) : Eigen::Vector2d(x, y);
      const std::optional<Eigen::Vector2d> pixel = region.pixel(plane_point(output, from.x(), from.y()));
      if (!pixel) continue;
      const Sample column = sample_at(pixel->x(), halvings, region.input_width());
      const Sample row = sample_at(pixel->y(), halvings, region.input_height());
      const std::size_t i = static_cast<std::size_t>(y) * output.width + x;
      table.offset[i] = row.first * stride + column.first;
      table.fraction_x[i] = column.fraction;
      table.fraction_y[i] = row.fraction;
    }
  }
  return table;
}

MaskedImage halve(ImageView<const float> image) {
  MaskedImage result(image.width / 2, image.height / 2);
  downsample(image, result.view());
  return result;
}

}  // namespace

Rectifier::Rectifier(const CameraCalibration& camera, const Rectification& rectification)
    : Rectifier(camera, rectification, Displacement()) {}

Rectifier::Rectifier(const CameraCalibration& camera, const Rectification& rectification, const Displacement& warp) {
  const VisibleRegion region(camera);
  output_camera_ = fit_pinhole(camera, rectification, region);
  is_identity_ = !warp && same_camera(camera, output_camera_);
  if (is_identity_) return;
  halvings_ = count_halvings(region, output_camera_);
  table_ = make_table(region, output_camera_, halvings_, warp);
}

void Rectifier::apply(ImageView<const float> input, ImageView<float> output) const {
  if (is_identity_) {
    for (int y = 0; y < input.height; ++y) std::copy_n(input.row(y), input.width, output.row(y));
    return;
  }
  MaskedImage halved;
  for (int i = 0; i < halvings_; ++i) {
    halved = halve(input);
    input = halved.view();
  }
  remap(input, table_, output);
}

}  // namespace ldso
