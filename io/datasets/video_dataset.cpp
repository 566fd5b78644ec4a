#include "io/datasets/video_dataset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "io/images/opencv_grey.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// Those that read files; cv::CAP_ANY would look for cameras on the bus as well.
constexpr std::array<int, 3> kFileBackends{cv::CAP_FFMPEG, cv::CAP_OPENCV_MJPEG, cv::CAP_GSTREAMER};

/// That even a frame like the one before takes in a file, with its place in the index.
constexpr std::uintmax_t kLeastBytesOfFrame = 8;

/// Of a file that does not say.
constexpr double kDefaultFps = 30.0;

/// Frames that are decoded and kept at once when reading backwards.
constexpr int kBlock = 32;

/// Decodes the frames of a file in any order.
class VideoReader {
 public:
  explicit VideoReader(fs::path path) : path_(std::move(path)) { reopen(); }

  double fps() const { return capture_.get(cv::CAP_PROP_FPS); }

  /// What the container says, or counted where it says nothing or more than its file has room for.
  int count_frames() {
    const double announced = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    std::error_code error;
    const double most = static_cast<double>(fs::file_size(path_, error) / kLeastBytesOfFrame);
    if (std::isfinite(announced) && announced >= 1 && announced < std::min(most, 1e9))
      return static_cast<int>(announced);
    int count = 0;
    while (capture_.grab()) ++count;
    reopen();
    return count;
  }

  /// Grey frame `index`, 8 bit. Throws Error if there is none.
  cv::Mat read(int index) {
    if (const auto kept = block_.find(index); kept != block_.end()) return kept->second;
    if (index >= next_) {
      block_.clear();
      return decode_at(index);
    }
    fill_block(std::max(0, index - kBlock + 1), index);
    return block_.at(index);
  }

 private:
  void reopen() {
    next_ = 0;
    const bool opened = std::any_of(kFileBackends.begin(), kFileBackends.end(),
                                    [this](int backend) { return capture_.open(path_.string(), backend); });
    if (opened) return;
    throw Error(path_.string(), "the video cannot be opened", "convert it, to H.264 in an .mp4 file for instance");
  }

  void fill_block(int first, int last) {
    block_.clear();
    go_back_to(first);
    for (int i = first; i <= last; ++i) block_[i] = decode_at(i);
  }

  /// Seeking is trusted only where the decoder confirms the position; otherwise decoding starts from the beginning.
  void go_back_to(int index) {
    const bool sought = capture_.set(cv::CAP_PROP_POS_FRAMES, index);
    if (sought && static_cast<int>(std::lround(capture_.get(cv::CAP_PROP_POS_FRAMES))) == index) {
      next_ = index;
    } else {
      reopen();
    }
  }

  cv::Mat decode_at(int index) {
    for (; next_ < index; ++next_) {
      if (!capture_.grab()) fail(index);
    }
    cv::Mat frame;
    if (!capture_.read(frame) || frame.empty()) fail(index);
    ++next_;
    return to_grey(frame);
  }

  [[noreturn]] void fail(int index) const {
    throw Error(path_.string(), "frame " + std::to_string(index) + " cannot be decoded; the video may be cut off",
                "use --end to stop before it");
  }

  fs::path path_;
  cv::VideoCapture capture_;
  int next_ = 0;  ///< Index of the frame that capture_ yields next.
  std::map<int, cv::Mat> block_;
};

class VideoDataset final : public Dataset {
 public:
  VideoDataset(const fs::path& path, const DatasetOptions& options) : path_(path), reader_(path) {
    calibration_ = read_calibration(options);
    count_ = reader_.count_frames();
    fps_ = frame_rate(options);
    check_size();
  }

  int size() const override { return count_; }
  double timestamp(int index) const override { return index / fps_; }
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

 private:
  Calibration read_calibration(const DatasetOptions& options) const {
    std::error_code error;
    const fs::path camera = options.calibration_file.value_or(path_.parent_path() / "camera.txt");
    if (!fs::exists(camera, error)) {
      throw Error(camera.string(), "there is no calibration of the camera that took the video",
                  "write a camera.txt beside the video or give one with --calib");
    }
    return read_camera_calibration(camera);
  }

  double frame_rate(const DatasetOptions& options) {
    const double fps = options.fps.value_or(reader_.fps());
    if (std::isfinite(fps) && fps > 0) return fps;
    if (options.fps) throw Error("--fps", "must be a positive number", "30, for instance");
    warnings_.push_back(path_.string() + ": the video does not say its frame rate; 30 Hz are assumed (see --fps)");
    return kDefaultFps;
  }

  void check_size() {
    if (count_ == 0) throw Error(path_.string(), "the video has no frames", "");
    const cv::Mat first = reader_.read(0);
    const CameraCalibration& camera = calibration_.camera;
    if (first.cols == camera.width && first.rows == camera.height) return;
    throw Error(path_.string(),
                "the video is " + std::to_string(first.cols) + "x" + std::to_string(first.rows) +
                    ", but the calibration (" + calibration_.description + ") is for another size",
                "give a calibration of this camera at this image size");
  }

  fs::path path_;
  mutable VideoReader reader_;  ///< Its position is no state that a user of the data set sees.
  Calibration calibration_;
  std::vector<std::string> warnings_;
  int count_ = 0;
  double fps_ = 0;
};

}  // namespace

bool is_video(const fs::path& file) {
  static const std::set<std::string> kExtensions{".avi", ".mp4", ".m4v", ".mov",  ".mkv",
                                                 ".mpg", ".wmv", ".ogv", ".webm", ".mpeg"};
  std::error_code error;
  return fs::is_regular_file(file, error) && kExtensions.contains(to_lower(file.extension().string()));
}

std::unique_ptr<Dataset> open_video(const fs::path& file, const DatasetOptions& options) {
  return std::make_unique<VideoDataset>(file, options);
}

}  // namespace ldso
