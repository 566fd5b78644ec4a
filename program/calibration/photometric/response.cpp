#include "calibration/photometric/response.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ldso/error.h"

namespace ldso {
namespace {

using Response = std::array<double, 256>;

constexpr std::size_t kLeastImages = 8;
constexpr double kLeastSpan = 8;
constexpr int kLeastLevels = 200;
constexpr int kMostSamples = 60000;
constexpr int kRounds = 60;
constexpr double kSettled = 1e-4;  // change of the inverse response in a round [levels]
constexpr std::uint8_t kSaturated = 255;

void check_images(const std::vector<ExposedImage>& images, const std::string& where) {
  if (images.size() < kLeastImages)
    throw Error(where, "there are " + std::to_string(images.size()) + " images, which do not tell the response",
                "take a still scene with 30 or more exposure times from almost black to almost white");
  const auto [least, most] = std::minmax_element(
      images.begin(), images.end(), [](const auto& a, const auto& b) { return a.exposure_ms < b.exposure_ms; });
  if (most->exposure_ms < kLeastSpan * least->exposure_ms)
    throw Error(where, "the longest exposure is less than 8 times the shortest",
                "take images from almost black to almost white, with the camera standing still");
}

/// Of each pixel, from all images in which it is not saturated; 0 where it always is.
std::vector<double> irradiance_of(const std::vector<ExposedImage>& images, const Response& response) {
  const std::size_t count = images.front().levels.size();
  std::vector<double> up(count), down(count);
  for (const ExposedImage& image : images) {
    const double t = image.exposure_ms;
    for (std::size_t i = 0; i < count; ++i) {
      if (image.levels[i] == kSaturated) continue;
      up[i] += t * response[image.levels[i]];
      down[i] += t * t;
    }
  }
  for (std::size_t i = 0; i < count; ++i) up[i] = down[i] > 0 ? up[i] / down[i] : 0;
  return up;
}

/// What is never seen lies between its neighbours, and saturation as far above the level before it as that above its
/// own.
void fill_gaps(const std::array<double, 256>& counts, Response& response) {
  int before = -1;
  for (int level = 0; level < kSaturated; ++level) {
    if (counts[static_cast<std::size_t>(level)] == 0) continue;
    for (int k = before + 1; before >= 0 && k < level; ++k) {
      const double part = static_cast<double>(k - before) / (level - before);
      response[static_cast<std::size_t>(k)] =
          (1 - part) * response[static_cast<std::size_t>(before)] + part * response[static_cast<std::size_t>(level)];
    }
    before = level;
  }
  constexpr int kSteps = 8;
  const auto last = static_cast<std::size_t>(std::max(before, kSteps));
  const double slope = (response[last] - response[last - kSteps]) / kSteps;
  for (std::size_t level = last + 1; level < 256; ++level) response[level] = response[level - 1] + std::max(0.0, slope);
}

struct Fit {
  Response response{};
  std::array<double, 256> counts{};
};

/// The mean of exposure times irradiance for each level.
Fit fit_response(const std::vector<ExposedImage>& images, const std::vector<double>& irradiance) {
  Fit fit;
  for (const ExposedImage& image : images) {
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
      const std::uint8_t level = image.levels[i];
      if (level == kSaturated || irradiance[i] == 0) continue;
      fit.response[level] += image.exposure_ms * irradiance[i];
      ++fit.counts[level];
    }
  }
  for (std::size_t level = 0; level < 256; ++level) {
    if (fit.counts[level] > 0) fit.response[level] /= fit.counts[level];
  }
  fill_gaps(fit.counts, fit.response);
  return fit;
}

/// From 0 to 255 without decreasing. The scale is free; an offset is not, and what black lacks is below it.
void normalize(Response& response) {
  response[0] = 0;
  for (std::size_t i = 1; i < 256; ++i) response[i] = std::max(response[i], response[i - 1]);
  const double scale = 255 / response[255];
  for (double& value : response) value *= scale;
}

double rms_of(const std::vector<ExposedImage>& images, const std::vector<double>& irradiance,
              const Response& response) {
  double sum = 0, count = 0;
  for (const ExposedImage& image : images) {
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
      if (image.levels[i] == kSaturated || irradiance[i] == 0) continue;
      sum += std::pow(response[image.levels[i]] - image.exposure_ms * irradiance[i], 2);
      ++count;
    }
  }
  return std::sqrt(sum / std::max(1.0, count));
}

}  // namespace

std::vector<std::uint8_t> sampled_levels(ImageView<const float> grey) {
  const double pixels = static_cast<double>(grey.width) * grey.height;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMostSamples))));
  std::vector<std::uint8_t> levels;
  for (int y = 0; y < grey.height; y += step) {
    for (int x = 0; x < grey.width; x += step)
      levels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(std::abs(grey(x, y))), 0L, 255L)));
  }
  return levels;
}

ResponseEstimate estimate_response(const std::vector<ExposedImage>& images, const std::string& where) {
  check_images(images, where);
  ResponseEstimate estimate;
  Response& response = estimate.inverse_response;
  for (std::size_t i = 0; i < 256; ++i) response[i] = static_cast<double>(i);
  for (int round = 0; round < kRounds; ++round) {
    const Fit fit = fit_response(images, irradiance_of(images, response));
    estimate.levels_seen =
        static_cast<int>(std::count_if(fit.counts.begin(), fit.counts.end(), [](double n) { return n > 0; }));
    if (estimate.levels_seen < kLeastLevels)
      throw Error(where, "only " + std::to_string(estimate.levels_seen) + " of 256 grey levels are seen",
                  "take more exposure times, of a scene with dark and bright parts");
    Response next = fit.response;
    normalize(next);
    double change = 0;
    for (std::size_t i = 0; i < 256; ++i) change = std::max(change, std::abs(next[i] - response[i]));
    response = next;
    if (change < kSettled) break;
  }
  estimate.rms = rms_of(images, irradiance_of(images, response), response);
  return estimate;
}

std::string response_text(const std::array<double, 256>& inverse_response) {
  std::ostringstream out;
  out.precision(9);
  for (std::size_t i = 0; i < 256; ++i) out << inverse_response[i] << (i == 255 ? '\n' : ' ');
  return out.str();
}

}  // namespace ldso
