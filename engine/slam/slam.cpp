#include "ldso/slam.h"

#include <cmath>
#include <utility>

#include "ldso/error.h"
#include "slam/pipeline.h"

namespace ldso {

struct Slam::Impl {
  Impl(const Calibration& calibration, const Settings& settings, LogSink log, std::shared_ptr<RunObserver> observer)
      : pipeline(calibration, settings, std::move(log), std::move(observer)) {}

  template <class T>
  FrameRecord process(ImageView<const T> image, float to_grey_levels, double timestamp,
                      std::optional<double> exposure_ms);

  Pipeline pipeline;
  std::int64_t next_id = 0;
  bool finished = false;
};

namespace {

/// 65535 is as bright as 255.
constexpr float k16BitPerGreyLevel = 257.0f;

template <class T>
Image<float> to_grey(ImageView<const T> image, float to_grey_levels) {
  Image<float> grey(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    const T* from = image.row(y);
    float* to = grey.row(y);
    for (int x = 0; x < image.width; ++x) to[x] = to_grey_levels * static_cast<float>(from[x]);
  }
  return grey;
}

}  // namespace

template <class T>
FrameRecord Slam::Impl::process(ImageView<const T> image, float to_grey_levels, double timestamp,
                                std::optional<double> exposure_ms) {
  const std::string name = "frame " + std::to_string(next_id);
  if (finished) throw Error(name, "the run has been finished", "make a new Slam for another run");
  if (!std::isfinite(timestamp)) throw Error(name, "its timestamp is not finite", "give seconds");
  if (image.data == nullptr) throw Error(name, "it has no pixels", "pass an image of the calibration's size");
  pipeline.preprocessor().check_size(name, image.width, image.height);
  auto raw = std::make_shared<RawFrame>();
  raw->id = next_id;
  raw->timestamp = timestamp;
  raw->exposure_ms = exposure_ms;
  raw->name = name;
  raw->grey = to_grey(image, to_grey_levels);
  std::shared_ptr<const PreparedFrame> prepared;
  {
    const StageTimer timer(pipeline.times(), "preprocess");
    prepared = std::make_shared<const PreparedFrame>(pipeline.preprocessor().process(*raw));
  }
  ++next_id;
  return pipeline.process(prepared, raw);
}

Slam::Slam(const Calibration& calibration, const Settings& settings, LogSink log, std::shared_ptr<RunObserver> observer)
    : impl_(std::make_unique<Impl>(calibration, settings, std::move(log), std::move(observer))) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

Slam::Impl& Slam::impl() const {
  if (!impl_) throw Error("Slam", "it has been moved from", "use the object it was moved to");
  return *impl_;
}

FrameRecord Slam::process(ImageView<const std::uint8_t> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, 1.0f, timestamp, exposure_ms);
}

FrameRecord Slam::process(ImageView<const std::uint16_t> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, 1.0f / k16BitPerGreyLevel, timestamp, exposure_ms);
}

FrameRecord Slam::process(ImageView<const float> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, 1.0f, timestamp, exposure_ms);
}

std::optional<SE3d> Slam::T_world_camera() const { return impl().pipeline.T_world_camera(); }

PinholeIntrinsics Slam::rectified_camera() const { return impl().pipeline.preprocessor().output_camera(); }

SlamResult Slam::finish() {
  if (impl().finished) throw Error("Slam::finish", "the run has been finished before", "keep its first result");
  impl().finished = true;
  return impl().pipeline.finish();
}

}  // namespace ldso
