#include "calibration/board/test_board_picture.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "calibration/board/board_drawing.h"

namespace ldso {
namespace {

constexpr int kSamples = 4;      // along a side of a pixel
constexpr double kCells = 3200;  // along the longer side of the board, about
constexpr float kBlack = 35, kWhite = 215, kGround = 130;

}  // namespace

BoardPainter::BoardPainter(const Board& board, const CameraModel& camera) {
  const BoardDrawing drawing = draw_board(board);
  upper_left_ = drawing.upper_left;
  lower_right_ = drawing.lower_right;
  const Eigen::Vector2d size = lower_right_ - upper_left_;
  // Whole cells for squares and for the bits of markers, so that edges are exactly where they belong.
  cells_per_metre_ = std::ceil(kCells / size.maxCoeff() * board.size / 400) * 400 / board.size;
  pattern_ = Image<std::uint8_t>(static_cast<int>(size.x() * cells_per_metre_ + 1),
                                 static_cast<int>(size.y() * cells_per_metre_ + 1), 1);
  const auto cell = [&](double metres) { return static_cast<int>(std::lround(metres * cells_per_metre_)); };
  for (const DrawnRectangle& r : drawing.rectangles) {
    const Eigen::Vector2d from = r.corner - upper_left_, to = from + r.size;
    for (int y = cell(from.y()); y < cell(to.y()); ++y) std::fill_n(&pattern_(cell(from.x()), y), cell(r.size.x()), 0);
  }
  for (const DrawnDisk& d : drawing.disks) {
    const Eigen::Vector2d c = (d.centre - upper_left_) * cells_per_metre_;
    const double radius = d.radius * cells_per_metre_;
    for (int y = static_cast<int>(c.y() - radius); y <= c.y() + radius; ++y) {
      for (int x = static_cast<int>(c.x() - radius); x <= c.x() + radius; ++x) {
        if (std::hypot(x + 0.5 - c.x(), y + 0.5 - c.y()) < radius) pattern_(x, y) = 0;
      }
    }
  }
  rays_ = Image<Eigen::Vector2f>(camera.calibration().width + 1, camera.calibration().height + 1,
                                 Eigen::Vector2f::Constant(NAN));
  for (int y = 0; y < rays_.height(); ++y) {
    for (int x = 0; x < rays_.width(); ++x) {
      if (const auto ray = camera.unproject({x - 0.5, y - 0.5})) rays_(x, y) = ray->head<2>().cast<float>();
    }
  }
}

float BoardPainter::level_at(const Eigen::Vector2f& cell) const {
  // No rounding down by a function: this is most of the time that a picture takes.
  const bool is_within = cell.x() >= 0 && cell.y() >= 0 && cell.x() < static_cast<float>(pattern_.width()) &&
                         cell.y() < static_cast<float>(pattern_.height());
  if (!is_within) return kGround;
  const int x = static_cast<int>(cell.x()), y = static_cast<int>(cell.y());
  return pattern_(x, y) == 0 ? kBlack : kWhite;
}

Image<float> BoardPainter::paint(const SE3d& pose, const BoardPictureOptions& options) const {
  // From rays to the plane z = 0 of the board.
  Eigen::Matrix3d to_rays = pose.rotation_matrix();
  to_rays.col(2) = pose.translation();
  Eigen::Matrix3d to_cells;
  to_cells << cells_per_metre_, 0, -upper_left_.x() * cells_per_metre_, 0, cells_per_metre_,
      -upper_left_.y() * cells_per_metre_, 0, 0, 1;
  const Eigen::Matrix3f H = (to_cells * to_rays.inverse()).cast<float>();
  const int width = rays_.width() - 1, height = rays_.height() - 1;
  cv::Mat picture(height, width, CV_32F);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const float a = (static_cast<float>(k % kSamples) + 0.5F) / kSamples;
        const float b = (static_cast<float>(k / kSamples) + 0.5F) / kSamples;
        const Eigen::Vector2f ray = (1 - b) * ((1 - a) * rays_(x, y) + a * rays_(x + 1, y)) +
                                    b * ((1 - a) * rays_(x, y + 1) + a * rays_(x + 1, y + 1));
        const Eigen::Vector3f p = H * ray.homogeneous();
        sum += p.z() > 0 ? level_at(p.head<2>() / p.z()) : kGround;
      }
      picture.at<float>(y, x) = sum / (kSamples * kSamples);
    }
  }
  if (options.blur > 0) cv::GaussianBlur(picture, picture, {0, 0}, options.blur);
  std::mt19937 random(options.seed);
  std::normal_distribution<float> noise(0, static_cast<float>(std::max(1e-9, options.noise)));
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image(x, y) = std::clamp(std::round(picture.at<float>(y, x) + noise(random)), 0.F, 255.F);
  }
  return image;
}

std::vector<SE3d> BoardPainter::poses(int count, std::uint32_t seed) const {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  const Eigen::Vector2d middle = 0.5 * (upper_left_ + lower_right_);
  const double side = (lower_right_ - upper_left_).maxCoeff();
  const int width = rays_.width(), height = rays_.height();
  // Not to the end of a fisheye's view, where a flat board would be seen from its edge.
  constexpr double kMostReach = 1.1;
  const double x_reach = std::min<double>(kMostReach, rays_(width - 1, height / 2).x());
  const double y_reach = std::min<double>(kMostReach, rays_(width / 2, height - 1).y());
  std::vector<SE3d> poses;
  while (poses.size() < static_cast<std::size_t>(count)) {
    const double distance = side / (2 * std::min(x_reach, y_reach)) * uniform(0.9, 1.7);
    const double room = std::max(0.0, 1 - 0.52 * side / distance / (2 * std::min(x_reach, y_reach)));
    const Eigen::Vector3d target(distance * x_reach * uniform(-room, room), distance * y_reach * uniform(-room, room),
                                 distance);
    const double tilt = uniform(0, 0.75), way = uniform(0, 6.283);
    const SO3<double> R = SO3<double>::exp({tilt * std::cos(way), tilt * std::sin(way), 0}) *
                          SO3<double>::exp({0, 0, uniform(-0.3, 0.3)});
    poses.emplace_back(R, target - R * Eigen::Vector3d(middle.x(), middle.y(), 0));
  }
  return poses;
}

}  // namespace ldso
