#include "io/images/dark_border.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

namespace ldso {
namespace {

/// Black is not quite black: noise, and the ringing of compression.
constexpr float kDarkest = 16;

/// Less of the image is not worth a mask, more leaves too little.
constexpr double kLeastShare = 0.01;
constexpr double kMostShare = 0.75;

/// Of the edge, relative to the image's smaller side: it is soft, and gradients look beyond it.
constexpr double kEdgeMargin = 0.012;

/// Of the points of the edge from a circle, relative to its radius.
constexpr double kMostRoundness = 0.015;

/// Of a row or a column that belongs to a bar.
constexpr double kBarShare = 0.995;

cv::Mat dark_pixels(ImageView<const float> brightest) {
  cv::Mat dark(brightest.height, brightest.width, CV_8U);
  for (int y = 0; y < brightest.height; ++y) {
    for (int x = 0; x < brightest.width; ++x) dark.at<std::uint8_t>(y, x) = brightest(x, y) <= kDarkest ? 255 : 0;
  }
  return dark;
}

/// Of the dark pixels those that hang together with the edge of the image.
cv::Mat connected_to_edge(const cv::Mat& dark) {
  cv::Mat labels;
  const int count = cv::connectedComponents(dark, labels, 4);
  std::vector<bool> touches(static_cast<std::size_t>(count), false);
  const auto touch = [&](int y, int x) { touches[static_cast<std::size_t>(labels.at<int>(y, x))] = true; };
  for (int x = 0; x < dark.cols; ++x) touch(0, x), touch(dark.rows - 1, x);
  for (int y = 0; y < dark.rows; ++y) touch(y, 0), touch(y, dark.cols - 1);
  touches[0] = false;  // What is not dark.
  cv::Mat border(dark.size(), CV_8U);
  for (int y = 0; y < dark.rows; ++y) {
    for (int x = 0; x < dark.cols; ++x)
      border.at<std::uint8_t>(y, x) = touches[static_cast<std::size_t>(labels.at<int>(y, x))] ? 255 : 0;
  }
  return border;
}

/// The bars alone: full rows from the top and the bottom, full columns from the sides.
cv::Mat bars_of(const cv::Mat& border) {
  cv::Mat rows, columns, bars = cv::Mat::zeros(border.size(), CV_8U);
  cv::reduce(border, rows, 1, cv::REDUCE_AVG, CV_64F);
  cv::reduce(border, columns, 0, cv::REDUCE_AVG, CV_64F);
  const auto is_full = [](double mean) { return mean >= kBarShare * 255; };
  for (int y = 0; y < border.rows && is_full(rows.at<double>(y)); ++y) bars.row(y).setTo(255);
  for (int y = border.rows - 1; y >= 0 && is_full(rows.at<double>(y)); --y) bars.row(y).setTo(255);
  for (int x = 0; x < border.cols && is_full(columns.at<double>(x)); ++x) bars.col(x).setTo(255);
  for (int x = border.cols - 1; x >= 0 && is_full(columns.at<double>(x)); --x) bars.col(x).setTo(255);
  return bars;
}

/// Centre and radius [px].
struct Circle {
  double x = 0, y = 0, radius = 0;
};

/// Points where the visible part ends inside of the image.
std::vector<cv::Point> inner_edge(const cv::Mat& border) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(255 - border, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<cv::Point> edge;
  if (contours.empty()) return edge;
  const auto largest = std::max_element(contours.begin(), contours.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (const cv::Point& p : *largest) {
    if (p.x > 0 && p.y > 0 && p.x < border.cols - 1 && p.y < border.rows - 1) edge.push_back(p);
  }
  return edge;
}

/// Least squares (Kasa), if the points lie on a circle.
std::optional<Circle> circle_through(const std::vector<cv::Point>& points) {
  if (points.size() < 32) return std::nullopt;
  Eigen::MatrixX3d A(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const cv::Point& p = points[static_cast<std::size_t>(i)];
    A.row(i) << 2.0 * p.x, 2.0 * p.y, 1.0;
    b[i] = double(p.x) * p.x + double(p.y) * p.y;
  }
  const Eigen::Vector3d s = A.colPivHouseholderQr().solve(b);
  const Circle circle{s[0], s[1], std::sqrt(std::max(0.0, s[2] + s[0] * s[0] + s[1] * s[1]))};
  double squares = 0;
  for (const cv::Point& p : points) {
    const double off = std::hypot(p.x - circle.x, p.y - circle.y) - circle.radius;
    squares += off * off;
  }
  if (std::sqrt(squares / double(points.size())) > kMostRoundness * circle.radius) return std::nullopt;
  return circle;
}

/// Whether the border is what lies outside of a circle about the middle of the image.
bool is_round(const cv::Mat& border, const Circle& circle) {
  const double off = std::hypot(circle.x - border.cols / 2.0, circle.y - border.rows / 2.0);
  if (off > 0.5 * circle.radius || 2 * circle.radius > 1.5 * std::max(border.cols, border.rows)) return false;
  const std::array<std::uint8_t, 4> corners{border.at<std::uint8_t>(0, 0), border.at<std::uint8_t>(0, border.cols - 1),
                                            border.at<std::uint8_t>(border.rows - 1, 0),
                                            border.at<std::uint8_t>(border.rows - 1, border.cols - 1)};
  return std::count(corners.begin(), corners.end(), 255) >= 3;
}

DarkBorder make_border(DarkBorderKind kind, const cv::Mat& dark) {
  const int margin = std::max(2, static_cast<int>(std::lround(kEdgeMargin * std::min(dark.cols, dark.rows))));
  cv::Mat wide;
  cv::dilate(dark, wide, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * margin + 1, 2 * margin + 1}));
  DarkBorder border{kind, Image<std::uint8_t>(dark.cols, dark.rows), 0};
  for (int y = 0; y < dark.rows; ++y) std::copy_n(wide.ptr<std::uint8_t>(y), dark.cols, border.mask.row(y));
  border.share = double(cv::countNonZero(wide)) / double(wide.total());
  return border;
}

double share_of(const cv::Mat& mask) { return double(cv::countNonZero(mask)) / double(mask.total()); }

bool is_worth_it(double share) { return share >= kLeastShare && share <= kMostShare; }

}  // namespace

DarkBorder find_dark_border(ImageView<const float> brightest) {
  if (brightest.width < 32 || brightest.height < 32) return {};
  const cv::Mat border = connected_to_edge(dark_pixels(brightest));
  if (!is_worth_it(share_of(border))) return {};
  if (const auto circle = circle_through(inner_edge(border)); circle && is_round(border, *circle))
    return make_border(DarkBorderKind::kRound, border);
  if (const cv::Mat bars = bars_of(border); is_worth_it(share_of(bars)))
    return make_border(DarkBorderKind::kBars, bars);
  return {};
}

}  // namespace ldso
