#include "io/datasets/bag_dataset.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>
#include <vector>

#include "io/bags/camera_info.h"
#include "io/bags/image_message.h"
#include "io/bags/message_header.h"
#include "io/calibration/foreign_calibration.h"
#include "io/calibration/unused_photometry.h"
#include "io/datasets/sequence_dataset.h"
#include "io/text/nearest_name.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr double kNanosecond = 1e-9;

/// Images are named by their number among the topic's messages.
class BagImages final : public ImageSource {
 public:
  BagImages(std::shared_ptr<const Bag> bag, std::size_t topic, std::string location)
      : bag_(std::move(bag)),
        topic_(bag_->topics()[topic]),
        location_(std::move(location)),
        messages_(bag_->messages(topic)) {}

  const std::vector<BagMessage>& messages() const { return messages_; }

  std::vector<std::string> names() const override {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < messages_.size(); ++i) names.push_back(std::to_string(i));
    return names;
  }
  std::vector<std::uint8_t> read(const std::string& name) const override {
    return image_file_of(bag_->read(message(name)), topic_, describe(name));
  }
  std::string describe(const std::string& name) const override {
    return location_ + ":" + topic_.name + (name.empty() ? "" : ", image " + name);
  }

  /// Of the header [ns]. Throws Error.
  std::int64_t stamp(const std::string& name) const {
    const std::vector<std::uint8_t> start = bag_->read(message(name), kStampBytes);
    WireReader reader(start, topic_.format, describe(name));
    return read_stamp(reader, topic_.format);
  }
  std::string frame(const std::string& name) const {
    const std::vector<std::uint8_t> bytes = bag_->read(message(name));
    WireReader reader(bytes, topic_.format, describe(name));
    return read_header(reader, topic_.format).frame;
  }

 private:
  const BagMessage& message(const std::string& name) const {
    std::size_t number = 0;
    std::from_chars(name.data(), name.data() + name.size(), number);
    return messages_.at(number);
  }

  std::shared_ptr<const Bag> bag_;
  BagTopic topic_;
  std::string location_;
  std::vector<BagMessage> messages_;
};

std::string list_of(const std::vector<BagTopic>& topics) {
  std::string text;
  for (const BagTopic& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + std::to_string(topic.count) + " " + topic.type + ")";
  }
  return text;
}

std::vector<BagTopic> image_topics(const Bag& bag) {
  std::vector<BagTopic> found;
  std::copy_if(bag.topics().begin(), bag.topics().end(), std::back_inserter(found),
               [](const BagTopic& topic) { return has_images(topic) && topic.count > 0; });
  return found;
}

std::size_t topic_named(const Bag& bag, const std::string& name, const std::string& location) {
  const std::vector<BagTopic>& topics = bag.topics();
  // A name may lack the slash in front, or what says how its images are packed.
  for (const std::string& wanted : {name, "/" + name, name + "/compressed", "/" + name + "/compressed"}) {
    const auto found = std::find_if(topics.begin(), topics.end(), [&](const BagTopic& topic) {
      return topic.name == wanted && has_images(topic) && topic.count > 0;
    });
    if (found != topics.end()) return static_cast<std::size_t>(found - topics.begin());
  }
  const std::vector<BagTopic> candidates = image_topics(bag);
  std::vector<std::string> names;
  for (const BagTopic& topic : candidates) names.push_back(topic.name);
  throw Error(location, "there are no images on the topic '" + name + "'",
              names.empty() ? "its topics are " + list_of(topics)
                            : "did you mean " + nearest_name(name, names) + "? Images are on " + list_of(candidates));
}

std::size_t choose_topic(const Bag& bag, const std::string& name, const std::string& location) {
  if (!name.empty()) return topic_named(bag, name, location);
  const std::vector<BagTopic> candidates = image_topics(bag);
  if (candidates.size() == 1) return topic_named(bag, candidates.front().name, location);
  if (candidates.empty()) {
    throw Error(location, "there are no images of a camera in the bag",
                bag.topics().empty() ? "it has no topics" : "its topics are " + list_of(bag.topics()));
  }
  throw Error(location, "there are images on several topics: " + list_of(candidates),
              "choose one by --topic " + candidates.front().name);
}

struct StampedImages {
  std::vector<FrameEntry> frames;
  std::size_t unread = 0;  ///< Messages that are damaged or cut off.
  std::string problem;     ///< Of the first of them.
};

/// The first `most` images. Those without a time in the header have that of the recording.
StampedImages read_stamps(const BagImages& images, std::size_t most, std::vector<std::string>& warnings) {
  StampedImages result;
  std::size_t unstamped = 0;
  const std::size_t count = std::min(images.messages().size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = std::to_string(i);
    try {
      const std::int64_t stamp = images.stamp(name);
      unstamped += stamp == 0 ? 1 : 0;
      const std::int64_t time = stamp == 0 ? images.messages()[i].time_ns : stamp;
      result.frames.push_back({name, static_cast<double>(time) * kNanosecond, std::nullopt});
    } catch (const Error& error) {
      if (result.unread++ == 0) result.problem = error.what();
    }
  }
  if (unstamped > 0) {
    warnings.push_back(images.describe("") + ": " + std::to_string(unstamped) +
                       " images have no time in their header; that of the recording is taken, which is less exact");
  }
  return result;
}

/// Networks may bring images in another order than the camera took them.
void sort_by_stamp(std::vector<FrameEntry>& frames, const std::string& location, std::vector<std::string>& warnings) {
  const auto is_earlier = [](const FrameEntry& a, const FrameEntry& b) { return a.timestamp < b.timestamp; };
  std::size_t count = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) count += is_earlier(frames[i], frames[i - 1]) ? 1 : 0;
  if (count == 0) return;
  warnings.push_back(location + ": " + std::to_string(count) +
                     " images were recorded after one that was taken later; all are sorted by the times in their "
                     "headers");
  std::stable_sort(frames.begin(), frames.end(), is_earlier);
}

std::vector<FrameEntry> read_frames(const BagImages& images, const DatasetOptions& options,
                                    std::vector<std::string>& warnings) {
  const bool is_from_start = options.end && *options.end > 0;
  const std::size_t most = is_from_start ? static_cast<std::size_t>(*options.end) : images.messages().size();
  StampedImages found = read_stamps(images, most, warnings);
  const std::string location = images.describe("");
  if (found.frames.empty()) throw Error(location, "none of its images can be read", found.problem);
  if (found.unread > 0) {
    warnings.push_back(location + ": " + std::to_string(found.unread) +
                       " images are damaged or cut off and left out, first: " + found.problem);
  }
  sort_by_stamp(found.frames, location, warnings);
  for (std::size_t i = 0; options.fps && i < found.frames.size(); ++i)
    found.frames[i].timestamp = static_cast<double>(i) / *options.fps;
  return std::move(found.frames);
}

/// Given, of the bag, or beside it.
Calibration read_calibration(const Bag& bag, const BagTopic& topic, const BagImages& images, Sequence& sequence,
                             const DatasetOptions& options) {
  if (options.calibration_file) return read_camera_calibration(*options.calibration_file);
  std::error_code error;
  const fs::path beside = find_calibration(fs::path(sequence.location).parent_path());
  const bool is_beside = fs::exists(beside, error);
  const std::string frame = images.frame(sequence.frames.front().name);
  std::optional<Calibration> own =
      find_camera_info(bag, sequence.location, base_topic(topic), frame, sequence.warnings);
  if (own && is_beside)
    sequence.warnings.push_back(beside.string() + ": is not used, since the bag has a camera_info (see --calib)");
  if (own) return std::move(*own);
  if (is_beside) return read_camera_calibration(beside);
  Calibration unknown;
  unknown.source = CameraSource::kNone;  // Which one is known once an image has been seen.
  return unknown;
}

}  // namespace

std::unique_ptr<Dataset> open_bag_dataset(const fs::path& path, const DatasetOptions& options) {
  Sequence sequence;
  sequence.location = path.string();
  const std::shared_ptr<const Bag> bag = open_bag(path);
  sequence.warnings = bag->warnings();
  const std::size_t number = choose_topic(*bag, options.topic, sequence.location);
  const BagTopic& topic = bag->topics()[number];
  sequence.format_name = topic.format == MessageFormat::kRos1 ? "ROS 1 bag" : "ROS 2 bag";
  auto images = std::make_unique<BagImages>(bag, number, sequence.location);
  sequence.frames = read_frames(*images, options, sequence.warnings);
  sequence.calibration = read_calibration(*bag, topic, *images, sequence, options);
  warn_about_unused_photometry(path.parent_path(), sequence.calibration.photometric, sequence.warnings);
  sequence.images = std::move(images);
  return make_sequence_dataset(std::move(sequence));
}

}  // namespace ldso
