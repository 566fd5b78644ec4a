#include "calibration/board/marker_dictionary.h"

#include <algorithm>
#include <map>
#include <opencv2/aruco.hpp>

namespace ldso {
namespace {

const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME>& dictionaries() {
  static const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME> names{
      {"16h5", cv::aruco::DICT_APRILTAG_16h5},
      {"25h9", cv::aruco::DICT_APRILTAG_25h9},
      {"36h10", cv::aruco::DICT_APRILTAG_36h10},
      {"36h11", cv::aruco::DICT_APRILTAG_36h11},
      {"4x4_50", cv::aruco::DICT_4X4_50},
      {"4x4_100", cv::aruco::DICT_4X4_100},
      {"4x4_250", cv::aruco::DICT_4X4_250},
      {"4x4_1000", cv::aruco::DICT_4X4_1000},
      {"5x5_50", cv::aruco::DICT_5X5_50},
      {"5x5_100", cv::aruco::DICT_5X5_100},
      {"5x5_250", cv::aruco::DICT_5X5_250},
      {"5x5_1000", cv::aruco::DICT_5X5_1000},
      {"6x6_50", cv::aruco::DICT_6X6_50},
      {"6x6_100", cv::aruco::DICT_6X6_100},
      {"6x6_250", cv::aruco::DICT_6X6_250},
      {"6x6_1000", cv::aruco::DICT_6X6_1000},
      {"7x7_50", cv::aruco::DICT_7X7_50},
      {"7x7_100", cv::aruco::DICT_7X7_100},
      {"7x7_250", cv::aruco::DICT_7X7_250},
      {"7x7_1000", cv::aruco::DICT_7X7_1000},
      {"aruco_original", cv::aruco::DICT_ARUCO_ORIGINAL}};
  return names;
}

cv::Ptr<cv::aruco::Dictionary> open_dictionary(const std::string& name) {
  const auto found = dictionaries().find(name);
  return found == dictionaries().end() ? nullptr : cv::aruco::getPredefinedDictionary(found->second);
}

}  // namespace

int marker_dictionary_size(const std::string& name) {
  const auto dictionary = open_dictionary(name);
  return dictionary.empty() ? 0 : dictionary->bytesList.rows;
}

std::string marker_dictionary_names() {
  std::string names;
  for (const auto& [name, id] : dictionaries()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

Image<std::uint8_t> draw_marker(const std::string& dictionary, int id, int border) {
  const auto markers = open_dictionary(dictionary);
  const int cells = markers->markerSize + 2 * border;
  cv::Mat drawn;
  cv::aruco::drawMarker(markers, id, cells, drawn, border);
  Image<std::uint8_t> marker(cells, cells);
  for (int y = 0; y < cells; ++y) std::copy_n(drawn.ptr<std::uint8_t>(y), cells, marker.row(y));
  return marker;
}

std::vector<SeenMarker> find_markers(const Image<std::uint8_t>& grey, const std::string& dictionary, int border) {
  const cv::Mat image(grey.height(), grey.width(), CV_8U, const_cast<std::uint8_t*>(grey.data()));
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->markerBorderBits = border;
  // Markers of a board are small, and there are many of them.
  parameters->minMarkerPerimeterRate = 0.015;
  parameters->adaptiveThreshWinSizeMax = std::clamp(image.cols / 25, 23, 83);
  parameters->adaptiveThreshWinSizeStep = (parameters->adaptiveThreshWinSizeMax - 3) / 3;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(image, open_dictionary(dictionary), corners, ids, parameters);
  std::vector<SeenMarker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    SeenMarker marker{ids[i], {}};
    for (const cv::Point2f& corner : corners[i]) marker.corners.emplace_back(corner.x, corner.y);
    markers.push_back(marker);
  }
  return markers;
}

}  // namespace ldso
