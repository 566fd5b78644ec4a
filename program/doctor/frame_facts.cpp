#include "doctor/frame_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "util/median.h"

namespace ldso {
namespace {

/// Gradients from here on are told from noise [grey levels / px].
constexpr float kEdge = 8;

/// Grey levels from here on are saturated.
constexpr std::size_t kWhite = 253;

/// Differences below are those of compression; of equal images so many pixels may have more.
constexpr float kSame = 1.5F;
constexpr double kDifferentShare = 1e-4;

/// Images are followed at this width [px]: displacements count relative to it.
constexpr int kFlowWidth = 512;
constexpr int kCorners = 200;
constexpr double kMostReturnError = 1.5;  // of a corner that is followed forth and back [px]

cv::Mat as_mat(ImageView<const float> image) {
  // OpenCV has no constant matrices; nothing writes to this one.
  return {image.height, image.width, CV_32F, const_cast<float*>(image.data),
          static_cast<std::size_t>(image.stride) * sizeof(float)};
}

std::array<int, 256> histogram_of(ImageView<const float> grey) {
  std::array<int, 256> histogram{};
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x)
      ++histogram[static_cast<std::size_t>(std::clamp(grey(x, y) + 0.5F, 0.F, 255.F))];
  }
  return histogram;
}

/// The lowest level that has at least `count` pixels at or below it.
int level_of(const std::array<int, 256>& histogram, double count) {
  double below = 0;
  int level = 0;
  while (level < 255 && (below += histogram[static_cast<std::size_t>(level)]) < count) ++level;
  return level;
}

void measure_levels(ImageView<const float> grey, FrameFacts& facts) {
  const std::array<int, 256> histogram = histogram_of(grey);
  const double pixels = static_cast<double>(grey.width) * grey.height;
  double sum = 0;
  for (std::size_t level = 0; level < 256; ++level) sum += static_cast<double>(level) * histogram[level];
  const int low = level_of(histogram, 0.02 * pixels), high = level_of(histogram, 0.98 * pixels);
  facts.mean = sum / pixels;
  facts.dark_level = low;
  facts.bright_level = high;
  facts.white_share = std::accumulate(histogram.begin() + kWhite, histogram.end(), 0) / pixels;
  const auto used = std::count_if(histogram.begin() + low, histogram.begin() + high + 1, [](int n) { return n > 0; });
  facts.levels_share = static_cast<double>(used) / (high - low + 1);
}

cv::Mat gradient_of(const cv::Mat& grey) {
  cv::Mat dx, dy, length;
  const cv::Mat kernel = (cv::Mat_<float>(1, 3) << -0.5F, 0, 0.5F);
  cv::filter2D(grey, dx, CV_32F, kernel);
  cv::filter2D(grey, dy, CV_32F, kernel.t());
  cv::magnitude(dx, dy, length);
  return length;
}

/// That 1 % of the values exceed.
float high_value(const cv::Mat& values) {
  std::vector<float> all(values.begin<float>(), values.end<float>());
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size()));
  std::nth_element(all.begin(), place, all.end());
  return *place;
}

/// Large images are measured in their middle, at their own resolution.
cv::Mat middle_of(const cv::Mat& grey) {
  const int width = std::min(grey.cols, 960), height = std::min(grey.rows, 720);
  return grey(cv::Rect((grey.cols - width) / 2, (grey.rows - height) / 2, width, height));
}

void measure_edges(ImageView<const float> image, FrameFacts& facts) {
  const cv::Mat grey = middle_of(as_mat(image));
  const cv::Mat fine = gradient_of(grey);
  cv::Mat small;
  cv::resize(grey, small, {grey.cols / 4, grey.rows / 4}, 0, 0, cv::INTER_AREA);
  facts.edge_share = static_cast<double>(cv::countNonZero(fine > kEdge)) / static_cast<double>(fine.total());
  facts.softness = high_value(gradient_of(small)) / std::max(1e-3F, high_value(fine));
}

bool are_same(ImageView<const float> a, ImageView<const float> b) {
  const double most = kDifferentShare * a.width * a.height;
  int different = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) different += std::abs(a(x, y) - b(x, y)) > kSame ? 1 : 0;
    if (different > most) return false;
  }
  return true;
}

cv::Mat for_flow(ImageView<const float> image) {
  cv::Mat bytes, small;
  as_mat(image).convertTo(bytes, CV_8U);
  if (image.width <= kFlowWidth) return bytes;
  cv::resize(bytes, small, {kFlowWidth, std::max(8, image.height * kFlowWidth / image.width)}, 0, 0, cv::INTER_AREA);
  return small;
}

void measure_flow(const cv::Mat& before, const cv::Mat& after, PairFacts& facts) {
  std::vector<cv::Point2f> corners, there, back;
  cv::goodFeaturesToTrack(before, corners, kCorners, 0.01, 6);
  if (corners.size() < 8) return;
  std::vector<unsigned char> found, returned;
  const auto follow = [](const cv::Mat& a, const cv::Mat& b, auto& from, auto& to, auto& state) {
    cv::calcOpticalFlowPyrLK(a, b, from, to, state, cv::noArray(), {21, 21}, 4);
  };
  follow(before, after, corners, there, found);
  follow(after, before, there, back, returned);
  std::vector<double> lengths;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (found[i] == 0 || returned[i] == 0 || cv::norm(back[i] - corners[i]) > kMostReturnError) continue;
    lengths.push_back(cv::norm(there[i] - corners[i]));
  }
  facts.tracked_share = static_cast<double>(lengths.size()) / static_cast<double>(corners.size());
  if (!lengths.empty()) facts.flow = median_of(lengths) / before.cols;
}

}  // namespace

FrameFacts measure_frame(ImageView<const float> grey) {
  FrameFacts facts;
  measure_levels(grey, facts);
  measure_edges(grey, facts);
  return facts;
}

PairFacts measure_pair(ImageView<const float> before, ImageView<const float> after) {
  PairFacts facts;
  facts.is_repeated = are_same(before, after);
  const double a = cv::mean(as_mat(before))[0], b = cv::mean(as_mat(after))[0];
  facts.brightness_step = std::log((b + 1) / (a + 1));
  measure_flow(for_flow(before), for_flow(after), facts);
  return facts;
}

}  // namespace ldso
