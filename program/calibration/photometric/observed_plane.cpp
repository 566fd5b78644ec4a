#include <algorithm>
#include <cmath>

#include "calibration/board/board_detector.h"
#include "calibration/board/board_drawing.h"
#include "calibration/lens/first_lens.h"
#include "calibration/photometric/vignette.h"

namespace ldso {
namespace {

/// How far the plane reaches beyond the board, in sides of the board to each side of its middle.
constexpr double kPlaneReach = 1.5;
/// Saturated or almost black levels tell nothing.
constexpr float kBrightest = 250, kDarkest = 3;

}  // namespace

ObservedPlane::ObservedPlane(const Board& board, const CameraModel& camera,
                             const std::optional<std::array<double, 256>>& inverse_response)
    : board_(board), camera_(camera), response_(inverse_response) {
  const BoardDrawing drawing = draw_board(board);
  const Eigen::Vector2d size = drawing.lower_right - drawing.upper_left;
  const double side = 2 * kPlaneReach * size.maxCoeff();
  corner_ = 0.5 * (drawing.upper_left + drawing.lower_right) - Eigen::Vector2d::Constant(0.5 * side);
  cell_size_ = side / kCellsAlong;
}

double ObservedPlane::irradiance(float level) const {
  if (!response_) return level;
  const auto below = static_cast<std::size_t>(std::min(254.F, level));
  const double part = level - static_cast<float>(below);
  return (1 - part) * (*response_)[below] + part * (*response_)[below + 1];
}

std::optional<SE3d> ObservedPlane::find_pose(ImageView<const float> grey) const {
  const std::vector<Eigen::Vector2d> points = board_points(board_);
  ObservedView observed;
  for (const SeenPoint& seen : find_board(grey, board_)) {
    const Eigen::Vector2d& p = points[static_cast<std::size_t>(seen.id)];
    observed.board.emplace_back(p.x(), p.y(), 0);
    observed.pixels.push_back(seen.pixel);
  }
  return observed.board.empty() ? std::nullopt : board_pose(observed, camera_);
}

std::optional<PlaneView> ObservedPlane::view(ImageView<const float> grey) const {
  const auto pose = find_pose(grey);
  if (!pose) return std::nullopt;
  PlaneView view;
  for (int cell = 0; cell < cells(); ++cell) {
    const Eigen::Vector2d p =
        corner_ + cell_size_ * Eigen::Vector2d(cell % kCellsAlong + 0.5, cell / kCellsAlong + 0.5);
    const Eigen::Vector2d pixel = camera_.project(*pose * Eigen::Vector3d(p.x(), p.y(), 0));
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < grey.width - 1 && pixel.y() < grey.height - 1)) continue;
    const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
    const float a = static_cast<float>(pixel.x() - x), b = static_cast<float>(pixel.y() - y);
    const auto [least, most] = std::minmax({grey(x, y), grey(x + 1, y), grey(x, y + 1), grey(x + 1, y + 1)});
    if (least < kDarkest || most > kBrightest) continue;
    const float level =
        (1 - b) * ((1 - a) * grey(x, y) + a * grey(x + 1, y)) + b * ((1 - a) * grey(x, y + 1) + a * grey(x + 1, y + 1));
    view.samples.push_back({cell, pixel.cast<float>(), static_cast<float>(irradiance(level))});
  }
  return view;
}

}  // namespace ldso
