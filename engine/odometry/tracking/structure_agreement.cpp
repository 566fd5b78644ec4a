#include "odometry/tracking/structure_agreement.h"

#include <cmath>
#include <optional>

#include "geometry/pinhole_projection.h"
#include "image/interpolation.h"

namespace ldso {
namespace {

/// Of the reference's points every so many are looked at: hundreds suffice.
constexpr int kStride = 4;
/// Points on a weaker gradient are no edges [grey levels a pixel].
constexpr float kLeastContrast = 2;

/// Root mean square gradient of an image in which nothing is to be seen, at most [grey levels a pixel]. Noise of a grey
/// level leaves 0.2 on the second coarser level, a room at a tenth of its usual light 1.
constexpr double kLeastStructure = 0.3;
/// Pixels of the coarse image of which every so many are looked at, in each direction.
constexpr int kStructureStride = 2;

/// Pixel of the image that shows a pixel of the reference.
class PixelTransfer {
 public:
  PixelTransfer(const PinholeIntrinsics& camera, const SE3d& T)
      : camera_(camera), R_(T.rotation_matrix()), t_(T.translation()) {}

  std::optional<Eigen::Vector2f> operator()(double u, double v, double idepth) const {
    const Eigen::Vector3d x = R_ * viewing_ray(camera_, {u, v}) + t_ * idepth;
    if (!(x.z() > 0)) return std::nullopt;
    return project(camera_, x).cast<float>();
  }

 private:
  PinholeIntrinsics camera_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d t_;
};

}  // namespace

StructureAgreement structure_agreement(const AlignmentPoints& points, const ImageView<const Texel>& reference,
                                       const ImageView<const Texel>& image, const PinholeIntrinsics& camera,
                                       const SE3d& T_image_reference) {
  const PixelTransfer transfer(camera, T_image_reference);
  double products = 0, squares_reference = 0, squares_image = 0;
  StructureAgreement agreement;
  for (int i = 0; i < points.size(); i += kStride) {
    const float u = points.u[i], v = points.v[i];
    if (!is_interpolable(reference, u, v)) continue;
    const Texel here = bilinear(reference, u, v);
    const Eigen::Vector2f gradient(here.dx, here.dy);
    const float contrast = gradient.norm();
    if (!(contrast > kLeastContrast)) continue;
    const auto there = transfer(u, v, points.idepth[i]);
    const auto across = transfer(u + gradient.x() / contrast, v + gradient.y() / contrast, points.idepth[i]);
    if (!there || !across || !is_interpolable(image, there->x(), there->y())) continue;
    const Texel seen = bilinear(image, there->x(), there->y());
    const float seen_contrast = Eigen::Vector2f(seen.dx, seen.dy).dot(*across - *there);
    products += contrast * seen_contrast;
    squares_reference += contrast * contrast;
    squares_image += seen_contrast * seen_contrast;
    ++agreement.edges;
  }
  const double norm = std::sqrt(squares_reference * squares_image);
  agreement.correlation = norm > 0 ? products / norm : 0;
  return agreement;
}

bool has_structure(const ImageView<const Texel>& image) {
  double squares = 0;
  int count = 0;
  for (int y = 0; y < image.height; y += kStructureStride) {
    for (int x = 0; x < image.width; x += kStructureStride) {
      const Texel& texel = image.row(y)[x];
      squares += texel.dx * texel.dx + texel.dy * texel.dy;
      ++count;
    }
  }
  return count > 0 && squares > kLeastStructure * kLeastStructure * count;
}

}  // namespace ldso
