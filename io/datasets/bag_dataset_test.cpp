#include "io/datasets/bag_dataset.h"

#include <gtest/gtest.h>

#include "io/bags/test_bags.h"
#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImage = "sensor_msgs/Image";
constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
constexpr std::int64_t kRecordedLater = 30'000'000;

/// Frame `index` of the tests' sequences, taken at index / 10 s and recorded 30 ms later.
TestMessage raw_frame(const std::string& topic, int index, MessageFormat format) {
  TestImage image;
  image.stamp_ns = kBegin + index * 100'000'000;
  image.width = kTestWidth;
  image.height = kTestHeight;
  image.step = kTestWidth;
  const Image<float> frame = test_frame(index);
  image.data.assign(frame.data(), frame.data() + frame.size());
  return {topic, kImage, image.stamp_ns + kRecordedLater, image_message(image, format)};
}

std::vector<TestMessage> sequence(int count, MessageFormat format, const std::string& topic = "/cam/image_raw") {
  std::vector<TestMessage> messages{{"/cam/camera_info", "sensor_msgs/CameraInfo", kBegin, info_message({}, format)},
                                    {"/imu", "sensor_msgs/Imu", kBegin, Bytes(50)}};
  for (int i = 0; i < count; ++i) messages.push_back(raw_frame(topic, i, format));
  return messages;
}

DatasetOptions with_topic(const std::string& topic) {
  DatasetOptions options;
  options.topic = topic;
  return options;
}

void expect_whole(const Dataset& dataset, int count) {
  ASSERT_EQ(dataset.size(), count);
  EXPECT_EQ(dataset.calibration().camera.fx, 40);
  for (int i = 0; i < count; ++i) {
    EXPECT_NEAR(dataset.timestamp(i), 1.7e9 + i / 10.0, 1e-6);
    EXPECT_EQ(dataset.read(i).grey(3, 2), test_frame(i)(3, 2));
  }
}

TEST(BagDataset, HasFramesTimesAndCalibrationOfEveryFormat) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", sequence(5, MessageFormat::kRos1), {Packing::kLz4});
  write_mcap(folder / "a.mcap", sequence(5, MessageFormat::kCdr), {Packing::kZstd});
  write_mcap(folder / "ros1.mcap", sequence(5, MessageFormat::kRos1), {}, MessageFormat::kRos1);
  write_sqlite_bag(folder / "a.db3", sequence(5, MessageFormat::kCdr));
  for (const char* name : {"a.bag", "a.mcap", "ros1.mcap", "a.db3"}) {
    SCOPED_TRACE(name);
    const auto dataset = open_dataset(folder / name);
    EXPECT_TRUE(dataset->warnings().empty()) << dataset->warnings().front();
    EXPECT_EQ(dataset->format_name(),
              name == std::string("a.mcap") || name == std::string("a.db3") ? "ROS 2 bag" : "ROS 1 bag");
    expect_whole(*dataset, 5);
  }
}

TEST(BagDataset, CompressedImagesAreRead) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = sequence(0, MessageFormat::kCdr);
  for (int i = 0; i < 3; ++i) {
    write_grey_png(folder / "frame.png", test_frame(i).view());
    messages.push_back({"/cam/image_raw/compressed", "sensor_msgs/msg/CompressedImage", i,
                        compressed_message(kBegin + i * 100'000'000, "mono8; png compressed",
                                           read_bytes(folder / "frame.png"), MessageFormat::kCdr)});
  }
  write_mcap(folder / "a.mcap", messages);
  expect_whole(*open_dataset(folder / "a.mcap"), 3);
  expect_whole(*open_dataset(folder / "a.mcap", with_topic("cam/image_raw")), 3);
}

TEST(BagDataset, OfSeveralTopicsOneHasToBeChosen) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = sequence(3, MessageFormat::kCdr);
  for (int i = 0; i < 2; ++i) messages.push_back(raw_frame("/right/image", i, MessageFormat::kCdr));
  write_mcap(folder / "a.mcap", messages);
  const std::string several = error_of([&] { open_dataset(folder / "a.mcap"); });
  EXPECT_NE(several.find("/cam/image_raw (3 sensor_msgs/Image), /right/image (2 sensor_msgs/Image)"), std::string::npos)
      << several;
  EXPECT_NE(several.find("--topic"), std::string::npos);
  EXPECT_EQ(open_dataset(folder / "a.mcap", with_topic("/right/image"))->size(), 2);
  expect_whole(*open_dataset(folder / "a.mcap", with_topic("/cam/image_raw")), 3);
  const std::string unknown = error_of([&] { open_dataset(folder / "a.mcap", with_topic("/rigth/image")); });
  EXPECT_NE(unknown.find("did you mean /right/image"), std::string::npos) << unknown;
  EXPECT_NE(error_of([&] { open_dataset(folder / "a.mcap", with_topic("/imu")); }).find("no images"),
            std::string::npos);
}

TEST(BagDataset, WithoutImagesNamesWhatThereIs) {
  const TemporaryFolder folder;
  write_mcap(folder / "a.mcap", sequence(0, MessageFormat::kCdr));
  const std::string error = error_of([&] { open_dataset(folder / "a.mcap"); });
  EXPECT_NE(error.find("/imu (1 sensor_msgs/Imu)"), std::string::npos) << error;
}

TEST(BagDataset, TopicIsForBagsAlone) {
  const TemporaryFolder folder;
  const fs::path images = make_image_folder(folder / "images", 3);
  EXPECT_NE(error_of([&] { open_dataset(images, with_topic("/a")); }).find("is no ROS bag"), std::string::npos);
}

TEST(BagDataset, ThatIsCutOffHasWhatIsBefore) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.bag";
  write_ros1_bag(path, sequence(20, MessageFormat::kRos1), {Packing::kNone, 4});
  cut_off(path, fs::file_size(path) * 3 / 5);
  const auto dataset = open_dataset(path);
  EXPECT_GT(dataset->size(), 8);
  EXPECT_LT(dataset->size(), 14);
  expect_whole(*dataset, dataset->size());
  ASSERT_FALSE(dataset->warnings().empty());
  EXPECT_NE(dataset->warnings()[0].find("cut off"), std::string::npos) << dataset->warnings()[0];
}

TEST(BagDataset, CalibrationThatIsGivenOrBesideIsUsed) {
  const TemporaryFolder folder;
  write_text(folder / "given.txt", "Pinhole 44 41 15.5 11.5 0\n32 24\nnone\n32 24\n");
  write_text(folder / "camera.txt", "Pinhole 43 41 15.5 11.5 0\n32 24\nnone\n32 24\n");
  write_mcap(folder / "a.mcap", sequence(2, MessageFormat::kCdr));
  DatasetOptions options;
  options.calibration_file = folder / "given.txt";
  EXPECT_EQ(open_dataset(folder / "a.mcap", options)->calibration().camera.fx, 44);
  const auto of_bag = open_dataset(folder / "a.mcap");
  EXPECT_EQ(of_bag->calibration().camera.fx, 40);
  ASSERT_EQ(of_bag->warnings().size(), 1U);
  EXPECT_NE(of_bag->warnings()[0].find("camera.txt: is not used"), std::string::npos);
  // No camera_info for this one.
  std::vector<TestMessage> messages;
  messages.push_back(raw_frame("/image", 0, MessageFormat::kCdr));
  write_mcap(folder / "b.mcap", messages);
  EXPECT_EQ(open_dataset(folder / "b.mcap")->calibration().camera.fx, 43);
  fs::remove(folder / "camera.txt");
  EXPECT_TRUE(open_dataset(folder / "b.mcap")->calibration().is_guess());
}

TEST(BagDataset, ImagesAreSortedByTheirHeaders) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = sequence(4, MessageFormat::kCdr);
  std::swap(messages[3].bytes, messages[4].bytes);
  write_mcap(folder / "a.mcap", messages);
  const auto dataset = open_dataset(folder / "a.mcap");
  expect_whole(*dataset, 4);
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("sorted"), std::string::npos);
}

TEST(BagDataset, ImagesWithoutATimeHaveThatOfTheRecording) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = sequence(2, MessageFormat::kRos1);
  for (std::size_t i = 2; i < messages.size(); ++i) std::fill_n(messages[i].bytes.begin() + 4, 8, std::uint8_t{0});
  write_ros1_bag(folder / "a.bag", messages);
  const auto dataset = open_dataset(folder / "a.bag");
  EXPECT_NEAR(dataset->timestamp(1), 1.7e9 + 0.13, 1e-6);
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("no time"), std::string::npos);
}

TEST(BagDataset, DamagedImagesAreSkippedWhenPlayed) {
  const TemporaryFolder folder;
  std::vector<TestMessage> messages = sequence(3, MessageFormat::kCdr);
  messages[3].bytes.resize(300);
  messages[4].bytes.resize(5);
  write_mcap(folder / "a.mcap", messages);
  const auto dataset = open_dataset(folder / "a.mcap");
  EXPECT_EQ(dataset->size(), 2);
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("1 images are damaged"), std::string::npos);
  EXPECT_NE(error_of([&] { dataset->read(1); }).find("a.mcap:/cam/image_raw, image 1"), std::string::npos);
}

TEST(BagDataset, RateAndEndAreObeyed) {
  const TemporaryFolder folder;
  write_mcap(folder / "a.mcap", sequence(9, MessageFormat::kCdr));
  DatasetOptions options;
  options.fps = 20;
  options.end = 4;
  const auto dataset = open_dataset(folder / "a.mcap", options);
  EXPECT_EQ(dataset->size(), 4);
  EXPECT_NEAR(dataset->timestamp(2), 0.1, 1e-12);
}

TEST(BagDataset, IsFoundInAFolder) {
  const TemporaryFolder folder;
  write_mcap(folder / "recordings/a.mcap", sequence(1, MessageFormat::kCdr));
  EXPECT_NE(error_of([&] { open_dataset(folder.path()); }).find("recordings/a.mcap"), std::string::npos);
}

}  // namespace
}  // namespace ldso
