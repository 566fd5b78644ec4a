#include "io/datasets/video_dataset.h"

#include <gtest/gtest.h>

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

TEST(VideoDataset, NeedsACalibration) {
  const TemporaryFolder folder;
  const fs::path file = make_video(folder.path(), 3);
  fs::remove(folder / "camera.txt");
  EXPECT_NE(error_of([&] { open_video(file, {}); }).find("--calib"), std::string::npos);
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
