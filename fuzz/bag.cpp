// ROS bags of all formats, and the messages in them.

#include "io/bags/bag.h"
#include "fuzz_target.h"
#include "io/datasets/bag_dataset.h"

using namespace ldso;

namespace {

constexpr std::size_t kMostMessages = 8;

void read_messages(const Bag& bag) {
  for (std::size_t topic = 0; topic < bag.topics().size(); ++topic) {
    const auto messages = bag.messages(topic);
    fuzz::expect(messages.size() == bag.topics()[topic].count, "a topic has as many messages as it says");
    for (std::size_t i = 0; i < std::min(messages.size(), kMostMessages); ++i) {
      if (i > 0) fuzz::expect(messages[i - 1].time_ns <= messages[i].time_ns, "messages are in the order of time");
      fuzz::accepted([&] { return bag.read(messages[i]).size(); });
    }
  }
}

void read_images(const std::filesystem::path& path, const std::string& topic) {
  DatasetOptions options;
  options.topic = topic;
  fuzz::accepted([&] {
    const auto dataset = open_bag_dataset(path, options);
    const CameraCalibration& c = dataset->calibration().camera;
    fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy}) && c.fx > 0 && c.fy > 0, "the camera is finite");
    for (int i = 0; i < std::min(dataset->size(), 3); ++i) {
      fuzz::expect(std::isfinite(dataset->timestamp(i)), "times are finite");
      fuzz::accepted([&] { return dataset->read(i).grey.width(); });
    }
    return true;
  });
}

}  // namespace

LDSO_FUZZ_TARGET(bag) {
  const auto path = fuzz::scratch_file("input.bag", input);
  const auto bag = fuzz::accepted([&] { return open_bag(path); });
  if (!bag) return;
  fuzz::accepted([&] { return read_messages(**bag), true; });
  for (std::size_t i = 0; i < std::min<std::size_t>((*bag)->topics().size(), 4); ++i)
    read_images(path, (*bag)->topics()[i].name);
}
