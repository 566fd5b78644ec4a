#include "odometry/tracking/structure_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "geometry/pinhole_projection.h"
#include "image/interpolation.h"

namespace ldso {
namespace {

/// Of the reference's points every so many are looked at: hundreds suffice.
constexpr int kStride = 4;
/// Points on a weaker gradient are no edges [grey levels a pixel].
constexpr float kLeastContrast = 2;

/// Cells of the image in each direction, for the share of it that agrees.
constexpr int kCells = 8;
/// With fewer edges nothing is said of a cell.
constexpr int kLeastEdgesOfCell = 3;
/// Correlation beyond which a cell agrees.
constexpr double kLeastCellCorrelation = 0.5;

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

struct ContrastSums {
  double products = 0, squares_reference = 0, squares_image = 0;
  int edges = 0;

  void add(double reference, double image) {
    products += reference * image;
    squares_reference += reference * reference;
    squares_image += image * image;
    ++edges;
  }
  double correlation() const {
    const double norm = std::sqrt(squares_reference * squares_image);
    return norm > 0 ? products / norm : 0;
  }
};

/// `use(pixel, reference, image)` for every edge in view of both: where the image shows it, and its contrast in both.
template <typename Use>
void for_edges(const StructureComparison& c, int stride, const Use& use) {
  const PixelTransfer transfer(c.camera, c.T_image_reference);
  for (int i = 0; i < c.points.size(); i += stride) {
    const float u = c.points.u[i], v = c.points.v[i];
    if (!is_interpolable(c.reference, u, v)) continue;
    const Texel here = bilinear(c.reference, u, v);
    const Eigen::Vector2f gradient(here.dx, here.dy);
    const float contrast = gradient.norm();
    if (!(contrast > kLeastContrast)) continue;
    const auto there = transfer(u, v, c.points.idepth[i]);
    const auto across = transfer(u + gradient.x() / contrast, v + gradient.y() / contrast, c.points.idepth[i]);
    if (!there || !across || !is_interpolable(c.image, there->x(), there->y())) continue;
    const Texel seen = bilinear(c.image, there->x(), there->y());
    use(*there, contrast, Eigen::Vector2f(seen.dx, seen.dy).dot(*across - *there));
  }
}

}  // namespace

StructureAgreement structure_agreement(const StructureComparison& comparison) {
  ContrastSums sums;
  for_edges(comparison, kStride, [&](const auto&, double reference, double image) { sums.add(reference, image); });
  return {sums.correlation(), sums.edges};
}

double agreeing_share(const StructureComparison& comparison) {
  std::array<ContrastSums, kCells * kCells> cells;
  const auto cell = [](float position, int size) {
    return std::clamp(static_cast<int>(kCells * position / static_cast<float>(size)), 0, kCells - 1);
  };
  for_edges(comparison, 1, [&](const Eigen::Vector2f& pixel, double reference, double image) {
    const int row = cell(pixel.y(), comparison.image.height), column = cell(pixel.x(), comparison.image.width);
    cells[static_cast<std::size_t>(row * kCells + column)].add(reference, image);
  });
  const auto agreeing = std::count_if(cells.begin(), cells.end(), [](const ContrastSums& sums) {
    return sums.edges >= kLeastEdgesOfCell && sums.correlation() > kLeastCellCorrelation;
  });
  return static_cast<double>(agreeing) / static_cast<double>(cells.size());
}

}  // namespace ldso
