#include "io/images/april_tag.h"

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <opencv2/aruco.hpp>
#include <optional>
#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

using Dictionary = cv::Ptr<cv::aruco::Dictionary>;

/// Null if there is no such family.
Dictionary dictionary_of(const std::string& family) {
  static const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME> names{
      {"16h5", cv::aruco::DICT_APRILTAG_16h5},
      {"25h9", cv::aruco::DICT_APRILTAG_25h9},
      {"36h10", cv::aruco::DICT_APRILTAG_36h10},
      {"36h11", cv::aruco::DICT_APRILTAG_36h11}};
  const auto found = names.find(family);
  return found == names.end() ? Dictionary() : cv::aruco::getPredefinedDictionary(found->second);
}

template <class Number>
bool read_number(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

using Corners = std::array<Eigen::Vector2d, 4>;

/// Part of each side that its line is fitted to: near the ends the corners round it off.
constexpr double kSideFrom = 0.12, kSideTo = 0.88;
constexpr int kMostProfiles = 60;

/// How far a profile across a side reaches: within the black border and the white margin [cells; px].
constexpr double kReach = 0.7;
constexpr double kLeastReach = 1.5, kMostReach = 8;
constexpr double kSampleStep = 0.5;  // [px]

/// Points farther from their line than this are something else, a shadow's edge for instance [px].
constexpr double kStray = 1;
constexpr int kRefinements = 3;

double grey_at(const cv::Mat& image, const Eigen::Vector2d& p) {
  const double x = std::clamp(p.x(), 0.0, image.cols - 1.001), y = std::clamp(p.y(), 0.0, image.rows - 1.001);
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const double a = x - u, b = y - v;
  const auto at = [&](int column, int row) { return static_cast<double>(image.at<float>(row, column)); };
  return (1 - b) * ((1 - a) * at(u, v) + a * at(u + 1, v)) + b * ((1 - a) * at(u, v + 1) + a * at(u + 1, v + 1));
}

/// How far from `p`, along the unit vector `outwards`, black becomes white: the mean of the rise. Blur that is the same
/// to both sides does not move it.
std::optional<double> edge_at(const cv::Mat& image, const Eigen::Vector2d& p, const Eigen::Vector2d& outwards,
                              double reach) {
  double sum = 0, moment = 0;
  for (double s = -reach; s <= reach; s += kSampleStep) {
    const double rise =
        grey_at(image, p + (s + 0.5 * kSampleStep) * outwards) - grey_at(image, p + (s - 0.5 * kSampleStep) * outwards);
    sum += std::max(0.0, rise);
    moment += std::max(0.0, rise) * s;
  }
  return sum > 10 ? std::optional(moment / sum) : std::nullopt;
}

/// A line by a point on it and its direction.
struct Line {
  Eigen::Vector2d point, direction;
};

/// Through points by least squares, without those that stray from it.
std::optional<Line> line_through(std::vector<Eigen::Vector2d> points) {
  std::optional<Line> line;
  for (int round = 0; round < 2; ++round) {
    if (points.size() < 5) return std::nullopt;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
    line = Line{mean, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(1)};
    const Eigen::Vector2d normal(-line->direction.y(), line->direction.x());
    std::erase_if(points, [&](const auto& p) { return std::abs(normal.dot(p - mean)) > kStray; });
  }
  return line;
}

/// The side from `a` to `b` of a square whose middle is `centre`.
std::optional<Line> side_between(const cv::Mat& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                 const Eigen::Vector2d& centre, int cells) {
  const Eigen::Vector2d along = b - a;
  Eigen::Vector2d outwards = Eigen::Vector2d(-along.y(), along.x()).normalized();
  if (outwards.dot(0.5 * (a + b) - centre) < 0) outwards = -outwards;
  const double reach = std::clamp(kReach * along.norm() / cells, kLeastReach, kMostReach);
  const int count = std::clamp(static_cast<int>(along.norm()), 8, kMostProfiles);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p = a + (kSideFrom + (kSideTo - kSideFrom) * i / (count - 1)) * along;
    if (const auto edge = edge_at(image, p, outwards, reach)) points.push_back(p + *edge * outwards);
  }
  return line_through(std::move(points));
}

/// Corners are where the sides meet: found from a whole side each, and not drawn inwards as a blurred corner is.
bool refine(const cv::Mat& image, int cells, Corners& corners) {
  for (int round = 0; round < kRefinements; ++round) {
    const Eigen::Vector2d centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    std::array<std::optional<Line>, 4> sides;
    for (std::size_t i = 0; i < 4; ++i) {
      sides[i] = side_between(image, corners[i], corners[(i + 1) % 4], centre, cells);
      if (!sides[i]) return false;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Line &before = *sides[(i + 3) % 4], &after = *sides[i];
      Eigen::Matrix2d A;
      A << before.direction, -after.direction;
      if (std::abs(A.determinant()) < 0.05) return false;
      const Eigen::Vector2d shift = A.inverse() * (after.point - before.point);
      corners[i] = before.point + shift.x() * before.direction;
    }
  }
  return true;
}

}  // namespace

int april_tag_count(const std::string& family) {
  const Dictionary dictionary = dictionary_of(family);
  return dictionary.empty() ? 0 : dictionary->bytesList.rows;
}

AprilTag parse_april_tag(const std::string& text, const std::string& where) {
  const std::string form = "write FAMILY:ID:METRES, as in 36h11:3:0.16";
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  AprilTag tag;
  if (first == std::string::npos || second == std::string::npos ||
      !read_number(text.substr(first + 1, second - first - 1), tag.id) ||
      !read_number(text.substr(second + 1), tag.metres) || !std::isfinite(tag.metres) || tag.metres <= 0)
    throw Error(where, "'" + text + "' is no tag", form);
  tag.family = text.substr(text.starts_with("tag") ? 3 : 0, first - (text.starts_with("tag") ? 3 : 0));
  const int count = april_tag_count(tag.family);
  if (count == 0) throw Error(where, "there is no family '" + tag.family + "'", "choose 16h5, 25h9, 36h10 or 36h11");
  if (tag.id < 0 || tag.id >= count)
    throw Error(where, "the family has no tag " + std::to_string(tag.id),
                "its ids are 0 to " + std::to_string(count - 1));
  return tag;
}

Image<std::uint8_t> draw_april_tag(const std::string& family, int id) {
  const Dictionary dictionary = dictionary_of(family);
  const int cells = dictionary->markerSize + 2;
  cv::Mat drawn;
  cv::aruco::drawMarker(dictionary, id, cells, drawn, 1);
  Image<std::uint8_t> tag(cells, cells);
  for (int y = 0; y < cells; ++y) std::copy_n(drawn.ptr<std::uint8_t>(y), cells, tag.row(y));
  return tag;
}

std::vector<SeenTag> find_april_tags(ImageView<const float> grey, const std::string& family) {
  cv::Mat exact(grey.height, grey.width, CV_32F), image;
  for (int y = 0; y < grey.height; ++y) std::copy_n(grey.row(y), grey.width, exact.ptr<float>(y));
  exact.convertTo(image, CV_8U);
  const Dictionary dictionary = dictionary_of(family);
  std::vector<std::vector<cv::Point2f>> found;
  std::vector<int> ids;
  cv::aruco::detectMarkers(image, dictionary, found, ids, cv::aruco::DetectorParameters::create());
  std::vector<SeenTag> tags;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    SeenTag tag;
    tag.id = ids[i];
    for (std::size_t k = 0; k < 4; ++k) tag.corners[k] = {found[i][k].x, found[i][k].y};
    if (refine(exact, dictionary->markerSize + 2, tag.corners)) tags.push_back(tag);
  }
  return tags;
}

}  // namespace ldso
