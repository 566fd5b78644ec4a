#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ldso/frame_source.h"
#include "ldso/io/trajectory_file.h"
#include "ldso/rgb.h"

namespace ldso {

/// An image sequence with its calibration, whatever its format on disk. Errors of read() name the file.
class Dataset : public FrameSource {
 public:
  /// Of the frame's file or archive entry, within its folder; where there is none, the frame's number.
  virtual std::string frame_name(int index) const { return std::to_string(index); }
  /// Frame `index` in colour, its rows and columns those of read(), nothing masked; three equal channels where there is
  /// no colour. For what shows a map or learns from its images: tracking takes grey levels. Throws Error likewise.
  virtual Image<Rgb> read_color(int index) const;
  /// Poses of this camera, if the sequence carries them; they need not be at the frames' times.
  virtual std::optional<Trajectory> ground_truth() const = 0;
  virtual std::string format_name() const = 0;
  /// What was odd about the sequence but could be worked around.
  virtual const std::vector<std::string>& warnings() const = 0;
};

struct DatasetOptions {
  /// First frame that is used.
  int start = 0;
  /// First frame after `start` that is not used any more; nothing or beyond the sequence: all are. Below zero it counts
  /// from the sequence's end: -3 leaves the last three frames out.
  std::optional<int> end = std::nullopt;
  /// Use every stride-th frame, beginning with `start`.
  int stride = 1;
  /// Play from the last to the first used frame; timestamps stay the sequence's own and so decrease.
  bool reverse = false;
  /// In camera.txt format; used instead of the sequence's own.
  std::optional<std::filesystem::path> calibration_file = std::nullopt;
  /// Of image folders and videos: leave calibrations beside the images unread, since one is to be made.
  bool uncalibrated = false;
  /// Frame rate of sequences without times [Hz].
  std::optional<double> fps = std::nullopt;
  /// Names of the images that are used, of several kinds in one folder: `%d` stands for a number, `*` for any text, as
  /// in "frame-%d.color.png". Empty: all, which have to be of one kind.
  std::string pattern = {};
  /// Topic of a ROS bag whose images are used, "/camera/image_raw". Empty: the only one that has images.
  std::string topic = {};
  /// What is not to be used, white: an image for all frames, or a folder with one for each. "none": nothing is masked,
  /// not even the black surroundings of a round image, which are otherwise.
  std::optional<std::filesystem::path> mask = std::nullopt;
};

/// Recognizes the format of a folder or file and opens it, with start, end, stride and reverse applied.
/// Throws Error saying what is missing, or what was looked for if the format is not recognized.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& path, const DatasetOptions& options = {});

}  // namespace ldso
