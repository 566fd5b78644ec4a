#include "camera/camera_stream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "io/images/opencv_images.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

constexpr const char* kPrefix = "camera:";

std::string full_name(const std::string& camera) { return kPrefix + camera; }

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 4 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// A device gives frames for ever; a stream may end.
bool is_device(const std::string& camera) { return is_number(camera) || camera.starts_with("/dev/"); }

Calibration read_calibration(const std::string& camera, const DatasetOptions& options) {
  if (!options.calibration_file) {
    throw Error(full_name(camera), "a camera needs its calibration",
                "give it with --calib camera.txt (docs/own-camera.md says how to get one)");
  }
  return read_camera_calibration(*options.calibration_file);
}

double system_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

class CameraStream final : public FrameStream {
 public:
  CameraStream(const std::string& camera, const DatasetOptions& options)
      : name_(full_name(camera)),
        is_device_(is_device(camera)),
        calibration_(read_calibration(camera, options)),
        end_(options.end.value_or(std::numeric_limits<int>::max())) {
    if (options.start != 0 || options.stride != 1 || options.reverse || end_ < 0) {
      throw Error(name_, "a camera can only be played from now on",
                  "leave out --start, --stride and --reverse; --end N ends after N frames");
    }
    if (options.mask) throw Error(name_, "masks are for sequences", "leave out --mask, or record and give the file");
    open(camera);
    ask_for_format(options.fps);
    check_size();
  }

  const Calibration& calibration() const override { return calibration_; }
  int size() const override { return end_ == std::numeric_limits<int>::max() ? 0 : end_; }

  std::optional<Arrival> wait(const std::function<bool()>& is_over) override {
    if (is_over() || next_ >= end_) return std::nullopt;
    if (!capture_.grab()) {
      if (!is_device_ && next_ > 0) return std::nullopt;
      throw Error(name_, "the camera gives no more images", "is it still plugged in?");
    }
    timestamp_ = system_seconds();
    return Arrival{next_++, timestamp_};
  }

  RawFrame read() override {
    cv::Mat frame;
    if (!capture_.retrieve(frame) || frame.empty()) throw Error(name_, "the image cannot be decoded", "");
    RawFrame raw;
    raw.id = next_ - 1;
    raw.timestamp = timestamp_;
    raw.name = name_ + ", frame " + std::to_string(raw.id);
    raw.grey = to_image(to_grey(frame));
    return raw;
  }

 private:
  void open(const std::string& camera) {
    if (is_number(camera)) {
      capture_.open(std::stoi(camera), cv::CAP_V4L2);
    } else if (is_device_) {
      capture_.open(camera, cv::CAP_V4L2);
    } else {
      capture_.open(camera, cv::CAP_FFMPEG);
      if (!capture_.isOpened()) capture_.open(camera, cv::CAP_OPENCV_MJPEG);
    }
    if (capture_.isOpened()) return;
    if (is_device_) {
      throw Error(name_, "there is no such camera, or it cannot be opened",
                  "`ls /dev/video*` shows the cameras there are, camera:N is /dev/videoN; another program may be using "
                  "it, your user may have to be in the group `video`, and a container needs --device");
    }
    throw Error(name_, "the stream cannot be opened",
                "check the address; camera:0 is the first camera of this machine");
  }

  void ask_for_format(const std::optional<double>& fps) {
    if (!is_device_) return;
    capture_.set(cv::CAP_PROP_FRAME_WIDTH, calibration_.camera.width);
    capture_.set(cv::CAP_PROP_FRAME_HEIGHT, calibration_.camera.height);
    if (fps) capture_.set(cv::CAP_PROP_FPS, *fps);
    capture_.set(cv::CAP_PROP_BUFFERSIZE, 2);  // What waits there is old.
  }

  void check_size() {
    const auto width = static_cast<int>(std::lround(capture_.get(cv::CAP_PROP_FRAME_WIDTH)));
    const auto height = static_cast<int>(std::lround(capture_.get(cv::CAP_PROP_FRAME_HEIGHT)));
    const CameraCalibration& camera = calibration_.camera;
    if (width == camera.width && height == camera.height) return;
    throw Error(name_,
                "the camera gives images of " + std::to_string(width) + "x" + std::to_string(height) +
                    ", but the calibration (" + calibration_.description + ") is for " + std::to_string(camera.width) +
                    "x" + std::to_string(camera.height),
                "calibrate it at a size that it has (`v4l2-ctl --list-formats-ext`)");
  }

  std::string name_;
  bool is_device_;
  Calibration calibration_;
  int end_;
  cv::VideoCapture capture_;
  std::int64_t next_ = 0;
  double timestamp_ = 0;
};

class CameraDataset final : public Dataset {
 public:
  CameraDataset(const std::string& camera, const Calibration& calibration)
      : name_(full_name(camera)), calibration_(calibration) {}

  int size() const override { return 0; }
  double timestamp(int) const override { return 0; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "camera"; }
  const std::vector<std::string>& warnings() const override { return calibration_.warnings; }
  RawFrame read(int) const override { throw Error(name_, "the images of a camera are not kept", ""); }

 private:
  std::string name_;
  Calibration calibration_;
};

}  // namespace

std::optional<std::string> camera_of(const std::string& input) {
  if (!input.starts_with(kPrefix)) return std::nullopt;
  return input.substr(std::string(kPrefix).size());
}

std::unique_ptr<FrameStream> open_camera(const std::string& camera, const DatasetOptions& options) {
  return std::make_unique<CameraStream>(camera, options);
}

std::unique_ptr<Dataset> make_camera_dataset(const std::string& camera, const Calibration& calibration) {
  return std::make_unique<CameraDataset>(camera, calibration);
}

}  // namespace ldso
