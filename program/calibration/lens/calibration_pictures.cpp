#include "calibration/lens/calibration_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace ldso {
namespace {

constexpr int kMostPictureSide = 1280;
constexpr int kCells = 16;       // along the longer side
constexpr int kLeastInCell = 3;  // points, for a mean that tells something
const cv::Scalar kGrid(90, 90, 90), kInk(230, 230, 230), kArrow(255, 190, 60);

/// A dark picture of the image's shape and what scales pixels to it.
struct Canvas {
  explicit Canvas(const CameraCalibration& camera)
      : scale(std::min(1.0, static_cast<double>(kMostPictureSide) / std::max(camera.width, camera.height))),
        picture(std::max(1, static_cast<int>(camera.height * scale)),
                std::max(1, static_cast<int>(camera.width * scale)), CV_8UC3, cv::Scalar(24, 24, 28)) {}

  cv::Point at(const Eigen::Vector2d& pixel) const {
    return {static_cast<int>(std::lround((pixel.x() + 0.5) * scale - 0.5)),
            static_cast<int>(std::lround((pixel.y() + 0.5) * scale - 0.5))};
  }

  void write(const std::string& text) {
    cv::putText(picture, text, {8, picture.rows - 10}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
  }

  Image<Rgb> image() const {
    Image<Rgb> result(picture.cols, picture.rows);
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        const auto& pixel = picture.at<cv::Vec3b>(y, x);
        result(x, y) = {pixel[0], pixel[1], pixel[2]};
      }
    }
    return result;
  }

  double scale;
  cv::Mat picture;  ///< RGB.
};

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

struct CellMean {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero(), residual = Eigen::Vector2d::Zero();
  int count = 0;
};

std::vector<CellMean> mean_residuals(const LensCalibration& lens) {
  const double side = static_cast<double>(std::max(lens.camera.width, lens.camera.height)) / kCells;
  std::vector<CellMean> cells(static_cast<std::size_t>(kCells) * kCells);
  for (const CalibratedView& view : lens.views) {
    for (const LensResidual& point : view.points) {
      const int column = std::clamp(static_cast<int>(point.pixel.x() / side), 0, kCells - 1);
      const int row = std::clamp(static_cast<int>(point.pixel.y() / side), 0, kCells - 1);
      CellMean& cell = cells[static_cast<std::size_t>(row * kCells + column)];
      cell.pixel += point.pixel;
      cell.residual += point.residual;
      ++cell.count;
    }
  }
  std::erase_if(cells, [](const CellMean& cell) { return cell.count < kLeastInCell; });
  for (CellMean& cell : cells) {
    cell.pixel /= cell.count;
    cell.residual /= cell.count;
  }
  return cells;
}

}  // namespace

Image<Rgb> draw_coverage(const LensCalibration& lens) {
  Canvas canvas(lens.camera);
  const cv::Size size = canvas.picture.size();
  for (int i = 1; i < 3; ++i) {
    cv::line(canvas.picture, {size.width * i / 3, 0}, {size.width * i / 3, size.height}, kGrid);
    cv::line(canvas.picture, {0, size.height * i / 3}, {size.width, size.height * i / 3}, kGrid);
  }
  for (const CalibratedView& view : lens.views) {
    for (const LensResidual& point : view.points) {
      const double off = std::min(1.0, point.residual.norm() / (3 * lens.rms));
      cv::circle(canvas.picture, canvas.at(point.pixel), 2, {60 + 195 * off, 220 - 160 * off, 70}, cv::FILLED,
                 cv::LINE_AA);
    }
  }
  canvas.write(std::to_string(lens.views.size()) + " views, " + std::to_string(lens.point_count()) +
               " points, red: off by " + rounded(3 * lens.rms) + " px");
  return canvas.image();
}

Image<Rgb> draw_residuals(const LensCalibration& lens) {
  Canvas canvas(lens.camera);
  const std::vector<CellMean> cells = mean_residuals(lens);
  double longest = 1e-9;
  for (const CellMean& cell : cells) longest = std::max(longest, cell.residual.norm());
  // The longest arrow is as long as a cell.
  const double side = static_cast<double>(std::max(lens.camera.width, lens.camera.height)) / kCells;
  for (const CellMean& cell : cells) {
    const Eigen::Vector2d end = cell.pixel + cell.residual * (side / longest);
    cv::arrowedLine(canvas.picture, canvas.at(cell.pixel), canvas.at(end), kArrow, 1, cv::LINE_AA, 0, 0.3);
  }
  canvas.write("mean residuals, the longest " + rounded(longest) + " px; all points " + rounded(lens.rms) + " px");
  return canvas.image();
}

}  // namespace ldso
