#include "image/photometric_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "image/masked_image.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr int kWidth = 33;
constexpr int kHeight = 17;

// G of a camera with gamma, and its exact inverse.
double response(double irradiance) { return 255 * std::pow(irradiance / 255, 1 / 1.7); }
double inverse_response(double grey) { return 255 * std::pow(grey / 255, 1.7); }

PhotometricCalibration gamma_camera() {
  PhotometricCalibration calibration;
  auto& table = calibration.inverse_response.emplace();
  for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(inverse_response(i));
  calibration.vignette = Image<float>(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double r2 = std::pow((x - 16) / 33.0, 2) + std::pow((y - 8) / 17.0, 2);
      calibration.vignette(x, y) = static_cast<float>(1 - 0.8 * r2);
    }
  }
  return calibration;
}

double scene(int x, int y) { return 20 + 4 * x + 3 * y; }

Image<float> apply(const PhotometricCalibration& calibration, const PhotometrySettings& settings,
                   const Image<float>& grey) {
  Image<float> result(grey.width(), grey.height());
  PhotometricCorrection(calibration, settings, grey.width(), grey.height()).apply(grey.view(), result.view());
  return result;
}

std::string error_of(const PhotometricCalibration& calibration) {
  try {
    const PhotometricCorrection correction(calibration, {}, kWidth, kHeight);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PhotometricCorrection, RecoversTheSceneFromWhatTheCameraMadeOfIt) {
  const PhotometricCalibration calibration = gamma_camera();
  Image<float> grey(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      grey(x, y) = static_cast<float>(response(calibration.vignette(x, y) * scene(x, y)));
  }
  const Image<float> result = apply(calibration, {}, grey);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_NEAR(result(x, y), scene(x, y), 0.01);  // the table is linear between grey levels
    }
  }
}

TEST(PhotometricCorrection, TakesTableValuesExactlyAndInterpolatesBetweenThem) {
  PhotometricCalibration calibration = gamma_camera();
  calibration.vignette = {};
  const auto& table = *calibration.inverse_response;
  Image<float> grey(3, 1);
  grey(0, 0) = 100;
  grey(1, 0) = 100.25f;
  grey(2, 0) = 0;
  const Image<float> result = apply(calibration, {}, grey);
  EXPECT_EQ(result(0, 0), table[100]);
  EXPECT_FLOAT_EQ(result(1, 0), 0.75f * table[100] + 0.25f * table[101]);
  EXPECT_EQ(result(2, 0), table[0]);
}

TEST(PhotometricCorrection, WithoutCalibrationChangesNothing) {
  Image<float> grey(kWidth, kHeight);
  for (std::size_t i = 0; i < grey.size(); ++i) grey.data()[i] = 0.4f * static_cast<float>(i);
  const Image<float> result = apply({}, {}, grey);
  for (std::size_t i = 0; i < grey.size(); ++i) EXPECT_EQ(result.data()[i], grey.data()[i]);
}

TEST(PhotometricCorrection, SettingsSwitchItOff) {
  const Image<float> grey(kWidth, kHeight, 100.0f);
  PhotometrySettings no_response;
  no_response.use_response = false;
  PhotometrySettings no_vignette;
  no_vignette.use_vignette = false;
  const PhotometricCalibration calibration = gamma_camera();
  const float v = calibration.vignette(0, 0);
  EXPECT_FLOAT_EQ(apply(calibration, no_response, grey)(0, 0), 100.0f / v);
  EXPECT_FLOAT_EQ(apply(calibration, no_vignette, grey)(0, 0), (*calibration.inverse_response)[100]);
  EXPECT_FALSE(PhotometricCorrection(calibration, no_response, kWidth, kHeight).has_response());
  EXPECT_TRUE(PhotometricCorrection(calibration, no_vignette, kWidth, kHeight).has_response());
}

TEST(PhotometricCorrection, MarksOverexposedPixelsAndThoseBehindABlackVignette) {
  PhotometricCalibration calibration = gamma_camera();
  calibration.vignette(5, 5) = 0;
  calibration.vignette(6, 5) = 1e-45f;  // its reciprocal is not a number to work with
  Image<float> grey(kWidth, kHeight, 100.0f);
  grey(1, 1) = 252.9f;
  grey(2, 1) = 253.0f;
  grey(3, 1) = 255.0f;
  grey(4, 1) = std::numeric_limits<float>::quiet_NaN();
  grey(5, 1) = std::numeric_limits<float>::infinity();
  const Image<float> result = apply(calibration, {}, grey);
  EXPECT_FALSE(is_marked(result(1, 1)));
  EXPECT_TRUE(is_marked(result(2, 1)));
  EXPECT_TRUE(is_marked(result(3, 1)));
  EXPECT_TRUE(is_marked(result(4, 1)));
  EXPECT_TRUE(is_marked(result(5, 1)));
  EXPECT_TRUE(is_marked(result(5, 5)));
  EXPECT_TRUE(is_marked(result(6, 5)));
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_TRUE(std::isfinite(result.data()[i]));
}

TEST(PhotometricCorrection, RefusesTablesThatAreNone) {
  const auto broken = [](const std::function<void(PhotometricCalibration&)>& change) {
    PhotometricCalibration calibration = gamma_camera();
    change(calibration);
    return error_of(calibration);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(broken([](PhotometricCalibration&) {}), "");
  EXPECT_NE(broken([](auto& c) { (*c.inverse_response)[7] = (*c.inverse_response)[6]; }).find("value 7"),
            std::string::npos);
  EXPECT_NE(broken([&](auto& c) { (*c.inverse_response)[9] = nan; }).find("value 9"), std::string::npos);
  EXPECT_NE(broken([](auto& c) { (*c.inverse_response)[0] = -1; }).find("value 0"), std::string::npos);
  EXPECT_NE(broken([](auto& c) { c.vignette = Image<float>(32, 17, 1.0f); }).find("32 x 17"), std::string::npos);
  EXPECT_NE(broken([](auto& c) { c.vignette(3, 4) = -0.1f; }).find("(3, 4)"), std::string::npos);
  EXPECT_NE(broken([](auto& c) { c.vignette(3, 4) = 1.1f; }).find("(3, 4)"), std::string::npos);
  EXPECT_NE(broken([&](auto& c) { c.vignette(3, 4) = nan; }).find("(3, 4)"), std::string::npos);
}

TEST(PhotometricCorrection, DoesNotCheckWhatItDoesNotUse) {
  PhotometricCalibration calibration = gamma_camera();
  (*calibration.inverse_response)[9] = 0;
  calibration.vignette = Image<float>(2, 2);
  PhotometrySettings off;
  off.use_response = off.use_vignette = false;
  EXPECT_NO_THROW(PhotometricCorrection(calibration, off, kWidth, kHeight));
}

}  // namespace
}  // namespace ldso
