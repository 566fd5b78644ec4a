#include "io/datasets/video_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "io/images/opencv_images.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Those that read files; cv::CAP_ANY would look for cameras on the bus as well.
constexpr std::array<int, 3> kFileBackends{cv::CAP_FFMPEG, cv::CAP_OPENCV_MJPEG, cv::CAP_GSTREAMER};

/// Frames that are decoded and kept at once when reading backwards.
constexpr int kBlock = 32;

/// Times of one frame, read twice, differ by no more [s].
constexpr double kSameTime = 1e-6;

/// Frames at the end that may lack a time: decoders hand out the last ones without it.
constexpr std::size_t kMostUntimed = 4;

/// Whether each time is later than the one before.
bool grow(std::span<const double> times) {
  const auto stays = [](double before, double after) { return !(after > before); };
  return std::all_of(times.begin(), times.end(), [](double time) { return std::isfinite(time); }) &&
         std::adjacent_find(times.begin(), times.end(), stays) == times.end();
}

/// Gives the last frames a time where the decoder has none: as far from the one before as that is from its own.
void complete_end(std::vector<double>& times) {
  const std::size_t begin = times.size() > kMostUntimed ? times.size() - kMostUntimed : 0;
  for (std::size_t i = std::max<std::size_t>(begin, 2); i < times.size(); ++i) {
    if (times[i] == 0 && times[i - 1] > 0) times[i] = 2 * times[i - 1] - times[i - 2];
  }
}

/// Calls a function of OpenCV that says whether it worked; some of its readers throw at damaged files instead.
template <typename Function>
bool succeeds(const Function& function) {
  try {
    return function();
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace

VideoReader::VideoReader(std::filesystem::path path) : path_(std::move(path)) { reopen(); }

int VideoReader::quarter_turns() const {
  const double degrees = capture_.get(cv::CAP_PROP_ORIENTATION_META);
  if (!(std::abs(degrees) <= 360)) return 0;
  return static_cast<int>(std::lround(std::abs(std::remainder(degrees, 360.0)) / 90));
}

VideoTimes VideoReader::scan(std::optional<int> most) {
  VideoTimes found;
  while (found.frames < most.value_or(std::numeric_limits<int>::max()) && grab()) {
    ++found.frames;
    found.seconds.push_back(capture_.get(cv::CAP_PROP_POS_MSEC) / 1000);
  }
  complete_end(found.seconds);
  if (!grow(found.seconds)) found.seconds.clear();
  times_ = found.seconds;
  reopen();
  return found;
}

cv::Mat VideoReader::read(int index) {
  if (const auto kept = block_.find(index); kept != block_.end()) return kept->second;
  if (index >= next_) {
    block_.clear();
    return to_grey(decode_at(index));
  }
  fill_block(std::max(0, index - kBlock + 1), index);
  return block_.at(index);
}

cv::Mat VideoReader::read_color(int index) {
  block_.clear();
  if (index < next_) go_back_to(index);
  return decode_at(index);
}

void VideoReader::reopen() {
  next_ = 0;
  const bool opened = std::any_of(kFileBackends.begin(), kFileBackends.end(), [this](int backend) {
    return succeeds([&] { return capture_.open(path_.string(), backend); });
  });
  if (!opened) {
    throw Error(path_.string(), "the video cannot be opened", "convert it, to H.264 in an .mp4 file for instance");
  }
  capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
}

void VideoReader::fill_block(int first, int last) {
  block_.clear();
  go_back_to(first);
  for (int i = first; i <= last; ++i) block_[i] = to_grey(decode_at(i));
}

void VideoReader::go_back_to(int index) {
  if (index > 0 && seek_before(index)) return;
  reopen();
}

bool VideoReader::seek_before(int index) {
  if (times_.empty()) return false;
  const double before = times_[static_cast<std::size_t>(index - 1)];
  // Decoders count frames by the average rate: with times that vary, only the time says which frame it became.
  if (!capture_.set(cv::CAP_PROP_POS_FRAMES, std::floor(before * fps())) || !grab()) return false;
  const double reached = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;
  const auto found = std::lower_bound(times_.begin(), times_.end(), reached - kSameTime);
  if (found == times_.end() || std::abs(*found - reached) > kSameTime) return false;
  next_ = static_cast<int>(found - times_.begin()) + 1;
  return next_ <= index;
}

cv::Mat VideoReader::decode_at(int index) {
  for (; next_ < index; ++next_) {
    if (!grab()) fail(index);
  }
  cv::Mat frame;
  if (!succeeds([&] { return capture_.read(frame); }) || frame.empty()) fail(index);
  ++next_;
  return frame;
}

bool VideoReader::grab() {
  return succeeds([this] { return capture_.grab(); });
}

void VideoReader::fail(int index) const {
  throw Error(path_.string(), "frame " + std::to_string(index) + " cannot be decoded; the video may be cut off",
              "use --end to stop before it");
}

}  // namespace ldso
