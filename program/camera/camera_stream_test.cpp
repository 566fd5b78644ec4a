#include "camera/camera_stream.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

bool never() { return false; }

DatasetOptions with_calibration(const TemporaryFolder& folder) {
  DatasetOptions options;
  options.calibration_file = folder / "camera.txt";
  write_text(*options.calibration_file, kTestCamera);
  return options;
}

TEST(CameraStream, IsToldFromSequences) {
  EXPECT_EQ(camera_of("camera:0"), "0");
  EXPECT_EQ(camera_of("camera:/dev/video2"), "/dev/video2");
  EXPECT_FALSE(camera_of("data/camera:0"));
  EXPECT_FALSE(camera_of("camera.mp4"));
}

TEST(CameraStream, MissingCameraSaysWhatToDo) {
  const TemporaryFolder folder;
  for (const char* camera : {"97", "/dev/video97"}) {
    const std::string message = error_of([&] { open_camera(camera, with_calibration(folder)); });
    EXPECT_NE(message.find(std::string("camera:") + camera + ": there is no such camera"), std::string::npos)
        << message;
    EXPECT_NE(message.find("ls /dev/video*"), std::string::npos) << message;
  }
  EXPECT_NE(error_of([&] {
              open_camera((folder / "none.avi").string(), with_calibration(folder));
            }).find("the stream cannot be opened"),
            std::string::npos);
}

TEST(CameraStream, NeedsACalibrationAndPlaysForwardOnly) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([] { open_camera("0", {}); }).find("--calib"), std::string::npos);
  DatasetOptions reverse = with_calibration(folder);
  reverse.reverse = true;
  EXPECT_NE(error_of([&] { open_camera("0", reverse); }).find("from now on"), std::string::npos);
}

/// A file stands in for a stream of the network.
TEST(CameraStream, GivesTheFramesOfAStreamUntilItsEnd) {
  const TemporaryFolder folder;
  const std::string video = make_video(folder.path(), 6).string();
  const auto stream = open_camera(video, with_calibration(folder));
  EXPECT_EQ(stream->size(), 0);
  double last = 0;
  for (int i = 0; i < 6; ++i) {
    const auto arrival = stream->wait(never);
    ASSERT_TRUE(arrival);
    EXPECT_EQ(arrival->index, i);
    EXPECT_GE(arrival->timestamp, last);
    last = arrival->timestamp;
    if (i == 2) continue;  // Nobody has to look at a frame.
    const RawFrame frame = stream->read();
    EXPECT_EQ(frame.id, i);
    EXPECT_NEAR(frame.grey(4, 4), test_frame(i)(4, 4), 4);
  }
  EXPECT_FALSE(stream->wait(never));
}

TEST(CameraStream, EndsWhenItIsToldTo) {
  const TemporaryFolder folder;
  DatasetOptions options = with_calibration(folder);
  options.end = 2;
  const auto stream = open_camera(make_video(folder.path(), 6).string(), options);
  EXPECT_EQ(stream->size(), 2);
  EXPECT_TRUE(stream->wait(never));
  EXPECT_FALSE(stream->wait([] { return true; }));
  EXPECT_TRUE(stream->wait(never));
  EXPECT_FALSE(stream->wait(never));
}

TEST(CameraStream, AnotherImageSizeIsRefused) {
  const TemporaryFolder folder;
  const std::string video = make_video(folder.path(), 3).string();
  DatasetOptions options = with_calibration(folder);
  options.calibration_file = folder / "large.txt";
  write_text(folder / "large.txt", "Pinhole 500 500 320 240 0\n640 480\nnone\n640 480\n");
  EXPECT_NE(error_of([&] { open_camera(video, options); }).find("but the calibration"), std::string::npos);
}

}  // namespace
}  // namespace ldso
