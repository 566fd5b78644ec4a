#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace ldso {

// Frames of a video file in any order, as the sensor gave them: a file may ask players to turn its frames, but
// calibration and rolling shutter are about the rows of the sensor.

/// What a pass over a video finds.
struct VideoTimes {
  int frames = 0;
  /// Of each frame [s]; empty if the file has no times that grow from frame to frame.
  std::vector<double> seconds;
};

class VideoReader {
 public:
  /// Throws Error if no decoder takes the file.
  explicit VideoReader(std::filesystem::path path);

  double fps() const { return capture_.get(cv::CAP_PROP_FPS); }

  /// By how many quarter turns players are asked to turn the frames: 0, 1 or 2. In which direction OpenCV's versions do
  /// not agree.
  int quarter_turns() const;

  /// Decodes all frames, or the first `most`: only that tells how many there are and when each was taken. Containers
  /// may not say it (streams) or be wrong, and rates that vary are only known frame by frame.
  VideoTimes scan(std::optional<int> most);

  /// Grey frame `index`, 8 bit. Throws Error if there is none.
  cv::Mat read(int index);

  /// The same as it was decoded. Going backwards is slow: nothing is kept.
  cv::Mat read_color(int index);

 private:
  void reopen();
  void fill_block(int first, int last);
  /// Seeking is trusted only where the time confirms the position, which decoders count by the average rate or, in
  /// streams, not at all; otherwise decoding starts from the beginning.
  void go_back_to(int index);
  bool seek_before(int index);
  /// As it was decoded; `index` is not before the next one.
  cv::Mat decode_at(int index);
  bool grab();
  [[noreturn]] void fail(int index) const;

  std::filesystem::path path_;
  cv::VideoCapture capture_;
  std::vector<double> times_;     ///< Of scan(): by them a position after seeking is confirmed.
  int next_ = 0;                  ///< Index of the frame that capture_ yields next.
  std::map<int, cv::Mat> block_;  ///< Decoded and kept when reading backwards.
};

}  // namespace ldso
