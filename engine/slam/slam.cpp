#include "ldso/slam.h"

#include <cmath>
#include <utility>

#include "image/grey_levels.h"
#include "image/working_size.h"
#include "ldso/error.h"
#include "slam/pipeline.h"
#include "slam/single_pass_watch.h"

namespace ldso {

struct Slam::Impl {
  Impl(const Calibration& calibration, const Settings& settings, LogSink log, std::shared_ptr<RunObserver> observer)
      : pipeline(calibration, settings, log, std::move(observer)),
        watch(calibration, settings.self_calibration, pipeline, std::move(log)) {}

  template <class T>
  FrameRecord process(ImageView<const T> image, double timestamp, std::optional<double> exposure_ms);

  Pipeline pipeline;
  SinglePassWatch watch;
  std::int64_t next_id = 0;
  bool finished = false;
};

template <class T>
FrameRecord Slam::Impl::process(ImageView<const T> image, double timestamp, std::optional<double> exposure_ms) {
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
  raw->grey = to_grey(image);
  std::shared_ptr<const PreparedFrame> prepared;
  {
    const StageTimer timer(pipeline.times(), "preprocess");
    prepared = std::make_shared<const PreparedFrame>(pipeline.preprocessor().process(*raw));
  }
  ++next_id;
  const FrameRecord& frame = pipeline.process(prepared, raw);
  watch.add(frame, pipeline);
  return frame;
}

namespace {

/// Frames that come one by one cannot wait for a camera to be found.
const Calibration& known(const Calibration& calibration) {
  if (!calibration.is_guess()) return calibration;
  throw Error("calibration", "there is none of the camera, and it cannot be found from frames that come one by one",
              "give one, or let run_sequence() look for it in a sequence that can be read again");
}

}  // namespace

Slam::Slam(const Calibration& calibration, const Settings& settings, LogSink log, std::shared_ptr<RunObserver> observer)
    : impl_(std::make_unique<Impl>(with_longest_side(known(calibration), settings.longest_side), settings,
                                   std::move(log), std::move(observer))) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

Slam::Impl& Slam::impl() const {
  if (!impl_) throw Error("Slam", "it has been moved from", "use the object it was moved to");
  return *impl_;
}

FrameRecord Slam::process(ImageView<const std::uint8_t> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, timestamp, exposure_ms);
}

FrameRecord Slam::process(ImageView<const std::uint16_t> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, timestamp, exposure_ms);
}

FrameRecord Slam::process(ImageView<const float> image, double timestamp, std::optional<double> exposure_ms) {
  return impl().process(image, timestamp, exposure_ms);
}

std::optional<SE3d> Slam::T_world_camera() const { return impl().pipeline.T_world_camera(); }

PinholeIntrinsics Slam::rectified_camera() const { return impl().pipeline.preprocessor().output_camera(); }

SlamResult Slam::snapshot() const {
  if (impl().finished) throw Error("Slam::snapshot", "the run has been finished", "use the result of finish()");
  return impl().pipeline.snapshot();
}

SlamResult Slam::finish() {
  if (impl().finished) throw Error("Slam::finish", "the run has been finished before", "keep its first result");
  impl().finished = true;
  impl().watch.decide(impl().pipeline);
  return impl().pipeline.finish();
}

}  // namespace ldso
