#include "image/frame_preprocessor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ldso/error.h"

namespace ldso {
namespace {

Calibration pinhole_calibration(int width, int height) {
  Calibration calibration;
  calibration.camera.width = width;
  calibration.camera.height = height;
  calibration.camera.fx = calibration.camera.fy = width;
  calibration.camera.cx = 0.5 * width;
  calibration.camera.cy = 0.5 * height;
  return calibration;
}

Calibration full_calibration(int width, int height) {
  Calibration calibration = pinhole_calibration(width, height);
  calibration.camera.model = CameraModelKind::kFov;
  calibration.camera.fx = calibration.camera.fy = 0.5 * width;
  calibration.camera.distortion = {0.9};
  calibration.rectification.mode = RectificationMode::kCrop;
  auto& table = calibration.photometric.inverse_response.emplace();
  for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(255 * std::pow(i / 255.0, 1.5));
  calibration.photometric.vignette = Image<float>(width, height, 0.5f);
  return calibration;
}

RawFrame raw_frame(int width, int height) {
  RawFrame raw;
  raw.id = 42;
  raw.timestamp = 1.25;
  raw.name = "00042.png";
  raw.grey = Image<float>(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      raw.grey(x, y) = static_cast<float>(std::lround(100 + 50 * std::sin(0.1 * x + 0.07 * y)));
  }
  return raw;
}

TEST(FramePreprocessor, NothingStaysOfWhatIsMasked) {
  const FramePreprocessor preprocessor(pinhole_calibration(320, 240), {});
  RawFrame raw = raw_frame(320, 240), other = raw_frame(320, 240);
  for (int y = 100; y < 140; ++y) {
    for (int x = 50; x < 90; ++x) {
      raw.grey(x, y) = -1;
      other.grey(x, y) = -1.F - static_cast<float>((31 * x + 17 * y) % 200);
    }
  }
  const PreparedFrame frame = preprocessor.process(raw);
  const Image<Texel>& level = frame.pyramid.levels[0];
  EXPECT_EQ(level(60, 110).valid, 0);
  EXPECT_EQ(level(49, 110).valid, 0);  // Its gradient looks into the mask.
  EXPECT_EQ(level(48, 110).valid, 1);
  EXPECT_TRUE(same_image(frame, preprocessor.process(other)));
}

TEST(FramePreprocessor, PassesAnUncalibratedPinholeFrameThrough) {
  const FramePreprocessor preprocessor(pinhole_calibration(320, 240), {});
  const RawFrame raw = raw_frame(320, 240);
  const PreparedFrame frame = preprocessor.process(raw);
  EXPECT_EQ(frame.id, 42);
  EXPECT_EQ(frame.timestamp, 1.25);
  EXPECT_FALSE(preprocessor.photometrically_calibrated());
  EXPECT_EQ(preprocessor.output_camera().fx, 320);
  ASSERT_EQ(frame.pyramid.levels.size(), 3u);
  const Image<Texel>& full = frame.pyramid.levels[0];
  for (int y = 1; y < 239; ++y) {
    for (int x = 1; x < 319; ++x) {
      ASSERT_EQ(full(x, y).intensity, raw.grey(x, y));
      ASSERT_EQ(full(x, y).dx, 0.5f * (raw.grey(x + 1, y) - raw.grey(x - 1, y)));
      ASSERT_EQ(full(x, y).dy, 0.5f * (raw.grey(x, y + 1) - raw.grey(x, y - 1)));
      ASSERT_EQ(full(x, y).valid, 1.0f);
    }
  }
}

TEST(FramePreprocessor, UndoesPhotometryBeforeItRectifies) {
  const Calibration calibration = full_calibration(320, 240);
  const FramePreprocessor preprocessor(calibration, {});
  EXPECT_TRUE(preprocessor.photometrically_calibrated());
  RawFrame raw;
  raw.grey = Image<float>(320, 240, 100.0f);
  const PreparedFrame frame = preprocessor.process(raw);
  const float expected = (*calibration.photometric.inverse_response)[100] / 0.5f;
  for (const Image<Texel>& level : frame.pyramid.levels) {
    for (std::size_t i = 0; i < level.size(); ++i) {
      ASSERT_FLOAT_EQ(level.data()[i].intensity, expected);
      ASSERT_EQ(level.data()[i].valid, 1.0f);
    }
  }
}

TEST(FramePreprocessor, OverexposureIsJudgedOnRawGreyLevels) {
  PhotometrySettings settings;
  settings.overexposed = 200;
  const FramePreprocessor preprocessor(full_calibration(320, 240), settings);
  RawFrame raw;
  raw.grey = Image<float>(320, 240, 199.0f);  // irradiance is above 255 here: no reason to drop it
  for (int y = 100; y < 120; ++y) {
    for (int x = 150; x < 170; ++x) raw.grey(x, y) = 200.0f;
  }
  const PreparedFrame frame = preprocessor.process(raw);
  const float bright = *std::max_element(&raw.grey(0, 0), &raw.grey(0, 0) + raw.grey.size());
  ASSERT_EQ(bright, 200.0f);
  int invalid = 0;
  const Image<Texel>& full = frame.pyramid.levels[0];
  const float dark = full(5, 5).intensity;
  for (int y = 0; y < full.height(); ++y) {
    for (int x = 0; x < full.width(); ++x) {
      invalid += full(x, y).valid == 0;
      if (full(x, y).valid == 0) continue;
      ASSERT_FLOAT_EQ(full(x, y).intensity, dark);  // nothing of the bright patch leaked into a valid texel
      ASSERT_NEAR(full(x, y).dx, 0, 1e-4);
      ASSERT_NEAR(full(x, y).dy, 0, 1e-4);
    }
  }
  EXPECT_GT(invalid, 200);
  EXPECT_LT(invalid, 800);
}

TEST(FramePreprocessor, UsesExposureOnlyIfItIsKnownAndWanted) {
  const FramePreprocessor preprocessor(pinhole_calibration(64, 48), {});
  RawFrame raw = raw_frame(64, 48);
  EXPECT_EQ(preprocessor.process(raw).exposure_ms, 1.0);
  EXPECT_FALSE(preprocessor.process(raw).exposure_known);
  raw.exposure_ms = 12.5;
  EXPECT_EQ(preprocessor.process(raw).exposure_ms, 12.5);
  EXPECT_TRUE(preprocessor.process(raw).exposure_known);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    raw.exposure_ms = bad;
    EXPECT_EQ(preprocessor.process(raw).exposure_ms, 1.0);
    EXPECT_FALSE(preprocessor.process(raw).exposure_known);
  }
  PhotometrySettings unwanted;
  unwanted.use_exposure = false;
  raw.exposure_ms = 12.5;
  EXPECT_FALSE(FramePreprocessor(pinhole_calibration(64, 48), unwanted).process(raw).exposure_known);
}

TEST(FramePreprocessor, NamesTheFrameAndBothSizesIfTheyDiffer) {
  const FramePreprocessor preprocessor(pinhole_calibration(320, 240), {});
  try {
    preprocessor.process(raw_frame(319, 240));
    FAIL() << "accepted";
  } catch (const Error& error) {
    const std::string message = error.what();
    for (const char* part : {"frame 42", "00042.png", "319 x 240", "320 x 240", "calibration file"}) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
  }
  EXPECT_THROW(preprocessor.process(RawFrame{}), Error);
}

TEST(FramePreprocessor, WorksForAnySize) {
  for (const auto& [width, height] :
       {std::pair{240, 180}, {416, 128}, {1242, 375}, {1280, 1024}, {641, 481}, {99, 67}, {17, 13}, {2, 2}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const FramePreprocessor preprocessor(full_calibration(width, height), {});
    const PreparedFrame frame = preprocessor.process(raw_frame(width, height));
    EXPECT_EQ(static_cast<int>(frame.pyramid.levels.size()), pyramid_level_count(width, height));
    for (const Image<Texel>& level : frame.pyramid.levels) {
      for (std::size_t i = 0; i < level.size(); ++i) ASSERT_EQ(level.data()[i].valid, 1.0f);
    }
  }
}

TEST(FramePreprocessor, GivesTheSameBitsOnAnyThread) {
  const FramePreprocessor preprocessor(full_calibration(320, 240), {});
  const RawFrame raw = raw_frame(320, 240);
  const PreparedFrame expected = preprocessor.process(raw);
  std::vector<PreparedFrame> results(4);
  {
    std::vector<std::jthread> threads;
    for (PreparedFrame& result : results) {
      threads.emplace_back([&] {
        for (int i = 0; i < 5; ++i) result = preprocessor.process(raw);
      });
    }
  }
  for (const PreparedFrame& result : results) {
    for (std::size_t level = 0; level < expected.pyramid.levels.size(); ++level) {
      const Image<Texel>& a = result.pyramid.levels[level];
      const Image<Texel>& b = expected.pyramid.levels[level];
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Texel)), 0);
    }
  }
}

}  // namespace
}  // namespace ldso
