#include "io/datasets/video_dataset.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/calibration/foreign_calibration.h"
#include "io/calibration/guessed_calibration.h"
#include "io/calibration/unused_photometry.h"
#include "io/datasets/video_reader.h"
#include "io/images/image_file.h"
#include "io/images/opencv_images.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// Of a file that does not say.
constexpr double kDefaultFps = 30.0;

/// A file's beginning that tells text from a video.
constexpr std::size_t kSniffedBytes = 512;

/// Gaps between frames that differ by more than this share of the median are no constant rate. Containers round times
/// to a millisecond, which is less at any rate of a camera.
constexpr double kConstantRate = 0.2;

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

class VideoDataset final : public Dataset {
 public:
  VideoDataset(const fs::path& path, const DatasetOptions& options) : path_(path), reader_(path) {
    const bool from_the_start = options.end && *options.end > 0;
    VideoTimes found = reader_.scan(from_the_start ? options.end : std::nullopt);
    count_ = found.frames;
    if (count_ == 0) throw Error(path_.string(), "the video has no frame that can be decoded", "convert it again");
    calibration_ = read_calibration(options);
    set_times(std::move(found.seconds), options);
    check_size();
    warnings_.insert(warnings_.end(), calibration_.warnings.begin(), calibration_.warnings.end());
    say_rotation();
    warn_about_unused_photometry(path_.parent_path(), calibration_.photometric, warnings_);
  }

  int size() const override { return count_; }
  double timestamp(int index) const override {
    return times_.empty() ? index / fps_ : times_.at(static_cast<std::size_t>(index));
  }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "video"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  RawFrame read(int index) const override {
    RawFrame raw;
    raw.id = index;
    raw.timestamp = timestamp(index);
    raw.name = path_.string() + ":" + std::to_string(index);
    raw.grey = to_image(reader_.read(index));
    return raw;
  }

  Image<Rgb> read_color(int index) const override { return to_rgb(reader_.read_color(index)); }

 private:
  Calibration read_calibration(const DatasetOptions& options) {
    std::error_code error;
    const fs::path camera = options.calibration_file.value_or(find_calibration(path_.parent_path()));
    const bool has_one = options.calibration_file || fs::exists(camera, error);
    if (has_one && !options.uncalibrated) return read_camera_calibration(camera);
    const cv::Mat first = reader_.read(0);
    return guess_calibration(first.cols, first.rows, std::nullopt);
  }

  /// The file's own times, unless a rate is given.
  void set_times(std::vector<double> times, const DatasetOptions& options) {
    if (!options.fps && !times.empty()) {
      times_ = std::move(times);
      say_varying_rate();
      return;
    }
    fps_ = frame_rate(options);
  }

  void say_varying_rate() {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < times_.size(); ++i) gaps.push_back(times_[i] - times_[i - 1]);
    if (gaps.empty()) return;
    std::sort(gaps.begin(), gaps.end());
    const double median = gaps[gaps.size() / 2];
    if (gaps.back() - gaps.front() <= kConstantRate * median) return;
    warnings_.push_back(path_.string() + ": the frame rate varies; gaps between frames are " +
                        std::to_string(std::lround(1000 * gaps.front())) + " to " +
                        std::to_string(std::lround(1000 * gaps.back())) +
                        " ms by the file's own times, which are used");
  }

  double frame_rate(const DatasetOptions& options) {
    const double fps = options.fps.value_or(reader_.fps());
    if (std::isfinite(fps) && fps > 0) {
      if (!options.fps) {
        warnings_.push_back(path_.string() + ": the video has no times of its own; " + std::to_string(fps) +
                            " Hz are assumed, as it says (see --fps)");
      }
      return fps;
    }
    if (options.fps) throw Error("--fps", "must be a positive number", "30, for instance");
    warnings_.push_back(path_.string() + ": the video does not say its frame rate; 30 Hz are assumed (see --fps)");
    return kDefaultFps;
  }

  void check_size() {
    const cv::Mat first = reader_.read(0);
    const CameraCalibration& camera = calibration_.camera;
    if (first.cols == camera.width && first.rows == camera.height) return;
    const bool swapped = first.cols == camera.height && first.rows == camera.width;
    throw Error(path_.string(),
                "the video is " + size_text(first.cols, first.rows) + (swapped ? " as it is stored" : "") +
                    ", but the calibration (" + calibration_.description + ") is for " +
                    size_text(camera.width, camera.height),
                swapped ? "players may turn it, but the rows of the sensor are what counts: calibrate with frames that "
                          "are not turned"
                        : "give a calibration of this camera at this image size");
  }

  void say_rotation() {
    const int turns = reader_.quarter_turns();
    if (turns == 0) return;
    warnings_.push_back(path_.string() + ": players are asked to turn it by " +
                        (turns == 1 ? "a quarter turn" : "half a turn") +
                        "; it is used as it is stored, since calibration and rolling shutter are about the rows of the "
                        "sensor");
  }

  fs::path path_;
  mutable VideoReader reader_;  ///< Its position is no state that a user of the data set sees.
  Calibration calibration_;
  std::vector<std::string> warnings_;
  int count_ = 0;
  std::vector<double> times_;  ///< Empty: by the rate.
  double fps_ = 0;
};

/// FFmpeg plays text as the screen of a terminal.
bool is_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string start(kSniffedBytes, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  const std::string_view read(start.data(), static_cast<std::size_t>(stream.gcount()));
  return std::none_of(read.begin(), read.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\f';
  });
}

bool opens_as_video(const fs::path& file) {
  try {
    return VideoReader(file).scan(1).frames > 0;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool has_video_extension(const fs::path& file) {
  static const std::set<std::string> kExtensions{".avi", ".mp4",  ".m4v",  ".mov",   ".mkv", ".mpg", ".wmv",
                                                 ".ogv", ".webm", ".mpeg", ".ts",    ".flv", ".3gp", ".3g2",
                                                 ".mts", ".m2ts", ".vob",  ".mjpeg", ".mxf", ".h264"};
  return kExtensions.contains(to_lower(file.extension().string()));
}

bool is_video(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  // A single image would be played as a video of one frame.
  return has_video_extension(file) || (!has_image_extension(file) && !is_text(file) && opens_as_video(file));
}

std::unique_ptr<Dataset> open_video(const fs::path& file, const DatasetOptions& options) {
  return std::make_unique<VideoDataset>(file, options);
}

}  // namespace ldso
