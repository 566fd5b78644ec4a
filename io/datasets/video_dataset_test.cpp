#include "io/datasets/video_dataset.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "io/datasets/test_sequences.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(VideoDataset, TakesTimesFromTheContainerOrTheOption) {
  const TemporaryFolder folder;
  const fs::path file = make_video(folder.path(), 8);
  EXPECT_NEAR(open_video(file, {})->timestamp(7), 0.7, 1e-6);
  EXPECT_NEAR(open_video(file, {.fps = 50})->timestamp(7), 0.14, 1e-12);
}

TEST(VideoDataset, PlaysLongVideosBackwards) {
  const TemporaryFolder folder;
  const auto dataset = open_video(make_video(folder.path(), 20), {});
  for (int i = dataset->size() - 1; i >= 0; --i) {
    ASSERT_NEAR(dataset->read(i).grey(4, 4), test_frame(i)(4, 4), 4) << i;
  }
}

TEST(VideoDataset, StreamsHaveTheirOwnTimesAndAreCountedByDecoding) {
  const TemporaryFolder folder;
  const std::vector<int> times{0, 100, 133, 400, 900, 1000, 1500};
  const auto dataset = open_video(make_matroska(folder.path(), times), {});
  ASSERT_EQ(dataset->size(), 7);
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(dataset->timestamp(i), times[static_cast<std::size_t>(i)] / 1e3, 1e-9);
    EXPECT_NEAR(dataset->read(i).grey(4, 4), test_frame(i)(4, 4), 4) << i;
  }
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("33 to 500 ms"), std::string::npos) << dataset->warnings()[0];
  EXPECT_DOUBLE_EQ(open_video(folder / "stream.mkv", {.fps = 50})->timestamp(6), 0.12);
}

TEST(VideoDataset, OfVaryingRatePlaysBackwards) {
  const TemporaryFolder folder;
  std::vector<int> times;
  for (int i = 0; i < 24; ++i) times.push_back(i * 40 + (i > 9 ? 700 : 0) + (i % 3) * 11);
  const auto dataset = open_video(make_matroska(folder.path(), times), {});
  for (int i = 23; i >= 0; i -= 5) ASSERT_NEAR(dataset->read(i).grey(4, 4), test_frame(i)(4, 4), 4) << i;
}

struct Container {
  const char* name;
  std::string codec;
};

/// Containers from which OpenCV cannot seek, or whose last frames have no time.
TEST(VideoDataset, EveryContainerIsReadAgainFromItsBeginning) {
  const std::vector<Container> containers{{"a.ts", "mpg1"},  {"a.mpg", "mpg1"}, {"a.webm", "VP80"}, {"a.flv", "FLV1"},
                                          {"a.3gp", "mp4v"}, {"a.mp4", "mp4v"}, {"a.mkv", "mp4v"}};
  for (const auto& [name, codec] : containers) {
    const TemporaryFolder folder;
    cv::VideoWriter writer((folder / name).string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 25.0, cv::Size(64, 48));
    if (!writer.isOpened()) continue;  // Which encoders there are differs from system to system.
    for (int i = 0; i < 9; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(25 * i)));
    writer.release();
    write_text(folder / "camera.txt", "Pinhole 60 60 31.5 23.5 0\n64 48\nnone\n64 48\n");
    const auto dataset = open_video(folder / name, {});
    ASSERT_EQ(dataset->size(), 9) << name;
    EXPECT_NEAR(dataset->timestamp(8), 0.32, 1.1e-3) << name;
    for (const int index : {0, 8, 5, 0, 1}) EXPECT_NEAR(dataset->read(index).grey(30, 30), 25 * index, 8) << name;
  }
}

TEST(VideoDataset, OfOneFrameIsASequence) {
  const TemporaryFolder folder;
  const auto dataset = open_video(make_matroska(folder.path(), {0}), {});
  ASSERT_EQ(dataset->size(), 1);
  EXPECT_NEAR(dataset->read(0).grey(4, 4), 8, 4);
}

TEST(VideoDataset, OnlyWhatIsPlayedIsLookedThrough) {
  const TemporaryFolder folder;
  DatasetOptions options;
  options.end = 3;
  EXPECT_EQ(open_video(make_video(folder.path(), 8), options)->size(), 3);
  options.end = -3;
  EXPECT_EQ(open_video(folder / "drive.avi", options)->size(), 8);
  EXPECT_EQ(open_dataset(folder / "drive.avi", options)->size(), 5);
}

/// Makes a video with `matrix` in its track header, which asks players to turn it.
fs::path make_turned_video(const fs::path& folder, const std::string& matrix) {
  const fs::path file = folder / "phone.mp4";
  cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 10.0,
                         cv::Size(kTestWidth, kTestHeight));
  for (int i = 0; i < 3; ++i) writer.write(cv::Mat(kTestHeight, kTestWidth, CV_8UC3, cv::Scalar::all(50 * i)));
  writer.release();
  std::string bytes = read_file(file);
  bytes.replace(bytes.find("tkhd") + 44, 20, matrix);
  write_text(file, bytes);
  write_text(folder / "camera.txt", kTestCamera);
  return file;
}

const std::string kTurnedBy90("\0\0\0\0\0\1\0\0\0\0\0\0\xff\xff\0\0\0\0\0\0", 20);
const std::string kTurnedBy180("\xff\xff\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\xff\0\0", 20);
const std::string kTurnedBy270("\0\0\0\0\xff\xff\0\0\0\0\0\0\0\1\0\0\0\0\0\0", 20);

TEST(VideoDataset, TurnedByItsPlayersIsUsedAsStored) {
  const std::string quarter = "by a quarter turn", half = "by half a turn";
  for (const auto& [matrix, turn] :
       {std::pair(kTurnedBy90, quarter), std::pair(kTurnedBy180, half), std::pair(kTurnedBy270, quarter)}) {
    const TemporaryFolder folder;
    const auto dataset = open_video(make_turned_video(folder.path(), matrix), {});
    EXPECT_EQ(dataset->read(1).grey.width(), kTestWidth);
    ASSERT_EQ(dataset->warnings().size(), 1U);
    EXPECT_NE(dataset->warnings()[0].find(turn), std::string::npos) << dataset->warnings()[0];
  }
}

TEST(VideoDataset, CalibrationOfTurnedFramesIsExplained) {
  const TemporaryFolder folder;
  make_turned_video(folder.path(), kTurnedBy90);
  write_text(folder / "camera.txt", "Pinhole 41 40 11.5 15.5 0\n24 32\nnone\n24 32\n");
  const std::string message = error_of([&] { open_video(folder / "phone.mp4", {}); });
  EXPECT_NE(message.find("32x24 as it is stored"), std::string::npos) << message;
}

TEST(VideoDataset, IsRecognizedByItsContentWhateverItsName) {
  const TemporaryFolder folder;
  const fs::path stream = make_matroska(folder.path(), {0, 40, 80});
  fs::copy_file(stream, folder / "recording");
  fs::copy_file(stream, folder / "recording.bin");
  EXPECT_TRUE(is_video(folder / "recording"));
  EXPECT_EQ(open_dataset(folder / "recording.bin")->size(), 3);
  write_text(folder / "notes", "a text\nof two lines\n");
  write_text(folder / "noise", std::string("\0\1\2\3", 4));
  write_frame(folder / "image.png", 1);
  for (const char* name : {"notes", "noise", "image.png", "camera.txt"}) EXPECT_FALSE(is_video(folder / name)) << name;
}

TEST(VideoDataset, WithoutCalibrationTheCameraIsAGuess) {
  const TemporaryFolder folder;
  const fs::path file = make_video(folder.path(), 3);
  const CameraCalibration known = open_video(file, {})->calibration().camera;
  fs::remove(folder / "camera.txt");
  const Calibration guess = open_video(file, {})->calibration();
  EXPECT_TRUE(guess.is_guess());
  EXPECT_EQ(guess.camera.width, known.width);
  EXPECT_EQ(guess.camera.height, known.height);
}

TEST(VideoDataset, DamagedFilesAreErrors) {
  const TemporaryFolder folder;
  write_text(folder / "camera.txt", kTestCamera);
  write_text(folder / "a.mp4", "this is no video");
  EXPECT_NE(error_of([&] { open_video(folder / "a.mp4", {}); }).find("a.mp4"), std::string::npos);
}

TEST(VideoDataset, FramesThatTheFileHasNoRoomForAreNotBelieved) {
  const TemporaryFolder folder;
  const fs::path file = make_video(folder.path(), 5);
  std::string bytes = read_file(file);
  for (const std::size_t count : {bytes.find("avih") + 8 + 16, bytes.find("strh") + 8 + 32})
    bytes.replace(count, 4, "\xff\xff\xff\x1f");
  write_text(file, bytes);
  EXPECT_EQ(open_video(file, {})->size(), 5);
}

}  // namespace
}  // namespace ldso
