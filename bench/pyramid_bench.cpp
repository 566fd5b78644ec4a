// What a frame costs before tracking: each image kernel beside its scalar reference, and the whole preparation.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "image/frame_preprocessor.h"
#include "image/irradiance_kernels.h"
#include "image/masked_image.h"
#include "image/pyramid.h"
#include "image/pyramid_kernels.h"
#include "image/rectifier.h"

namespace ldso {
namespace {

Image<float> textured_grey(int width, int height) {
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image(x, y) = std::round(127.0f + 80.0f * std::sin(0.05f * static_cast<float>(x + y)) +
                               40.0f * std::cos(0.11f * static_cast<float>(x - 2 * y)));
    }
  }
  return image;
}

Calibration lens(int width, int height, bool distorted, bool photometric) {
  Calibration result;
  CameraCalibration& camera = result.camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.7 * width;
  camera.cx = 0.5 * width - 0.5;
  camera.cy = 0.5 * height - 0.5;
  if (distorted) {
    camera.model = CameraModelKind::kRadTan;
    camera.distortion = {-0.28, 0.07, 2e-4, 2e-5};
    result.rectification.mode = RectificationMode::kCrop;
  }
  if (photometric) {
    auto& response = result.photometric.inverse_response.emplace();
    for (int i = 0; i < 256; ++i) response[i] = 255.0f * std::pow(static_cast<float>(i) / 255.0f, 1.8f);
    result.photometric.vignette = Image<float>(width, height, 0.8f);
  }
  return result;
}

void set_pixels(benchmark::State& state, int width, int height) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(width) * height);
}

template <auto kKernel>
void make_texels_of_image(benchmark::State& state) {
  const Image<float> image = textured_grey(640, 480);
  Image<Texel> texels(640, 480);
  for (auto _ : state) {
    kKernel(image.view(), texels.view());
    benchmark::DoNotOptimize(texels.data());
    benchmark::ClobberMemory();
  }
  set_pixels(state, 640, 480);
}
BENCHMARK(make_texels_of_image<&make_texels>)->Name("make_texels/simd");
BENCHMARK(make_texels_of_image<&scalar::make_texels>)->Name("make_texels/scalar");

template <auto kKernel>
void downsample_image(benchmark::State& state) {
  const Image<float> image = textured_grey(640, 480);
  Image<float> coarse(320, 240);
  for (auto _ : state) {
    kKernel(image.view(), coarse.view());
    benchmark::DoNotOptimize(coarse.data());
    benchmark::ClobberMemory();
  }
  set_pixels(state, 640, 480);
}
BENCHMARK(downsample_image<&downsample>)->Name("downsample/simd");
BENCHMARK(downsample_image<&scalar::downsample>)->Name("downsample/scalar");

template <auto kKernel>
void irradiance_of_image(benchmark::State& state) {
  const Image<float> image = textured_grey(640, 480);
  const Image<float> gain(640, 480, 1.25f);
  const Calibration calibration = lens(640, 480, false, true);
  const ResponseTable response(*calibration.photometric.inverse_response);
  const IrradianceTables tables{&response, gain.view(), 253.0f};
  MaskedImage masked(640, 480);
  for (auto _ : state) {
    kKernel(image.view(), tables, masked.view());
    benchmark::ClobberMemory();
  }
  set_pixels(state, 640, 480);
}
BENCHMARK(irradiance_of_image<&to_irradiance>)->Name("to_irradiance/simd");
BENCHMARK(irradiance_of_image<&scalar::to_irradiance>)->Name("to_irradiance/scalar");

void rectify(benchmark::State& state) {
  const Calibration calibration = lens(640, 480, true, false);
  const Rectifier rectifier(calibration.camera, calibration.rectification);
  const Image<float> image = textured_grey(640, 480);
  MaskedImage rectified(640, 480);
  for (auto _ : state) {
    rectifier.apply(image.view(), rectified.view());
    benchmark::ClobberMemory();
  }
  set_pixels(state, 640, 480);
}
BENCHMARK(rectify);

void pyramid(benchmark::State& state) {
  const Image<float> image = textured_grey(640, 480);
  for (auto _ : state) benchmark::DoNotOptimize(build_pyramid(image.view()));
  set_pixels(state, 640, 480);
}
BENCHMARK(pyramid);

/// Arguments: width, height, distorted lens, photometric calibration. Seven frames stay alive, as in the window.
void prepare_frame(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0));
  const int height = static_cast<int>(state.range(1));
  const FramePreprocessor preprocessor(lens(width, height, state.range(2) != 0, state.range(3) != 0), {});
  RawFrame raw;
  raw.grey = textured_grey(width, height);
  std::vector<PreparedFrame> window(7);
  std::size_t next = 0;
  for (auto _ : state) {
    window[next] = preprocessor.process(raw);
    next = (next + 1) % window.size();
    benchmark::ClobberMemory();
  }
  set_pixels(state, width, height);
}
BENCHMARK(prepare_frame)
    ->Unit(benchmark::kMillisecond)
    ->Args({640, 480, 0, 0})
    ->Args({640, 480, 0, 1})
    ->Args({640, 480, 1, 0})
    ->Args({640, 480, 1, 1})
    ->Args({416, 128, 0, 0})
    ->Args({752, 480, 1, 0})
    ->Args({1242, 375, 0, 0})
    ->Args({1280, 1024, 1, 1});

void make_rectifier(benchmark::State& state) {
  const Calibration calibration = lens(640, 480, true, false);
  for (auto _ : state) benchmark::DoNotOptimize(Rectifier(calibration.camera, calibration.rectification));
}
BENCHMARK(make_rectifier)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ldso
