#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

struct FormatCase {
  const char* name;
  const char* format_name;
  std::filesystem::path (*make)(const std::filesystem::path&, int);
  double first_timestamp;
  float tolerance;  ///< Grey levels; the video is compressed with loss.
};

class EveryFormat : public testing::TestWithParam<FormatCase> {
 protected:
  void expect_frames(const DatasetOptions& options, const std::vector<int>& expected) {
    const auto dataset = open_dataset(path_, options);
    EXPECT_EQ(dataset->format_name(), GetParam().format_name);
    ASSERT_EQ(dataset->size(), static_cast<int>(expected.size()));
    for (int i = 0; i < dataset->size(); ++i) {
      const int source = expected[static_cast<std::size_t>(i)];
      const RawFrame frame = dataset->read(i);
      EXPECT_EQ(frame.id, i);
      EXPECT_NEAR(frame.timestamp, GetParam().first_timestamp + 0.1 * source, 1e-6);
      EXPECT_EQ(dataset->timestamp(i), frame.timestamp);
      EXPECT_NEAR(frame.grey(5, 7), test_frame(source)(5, 7), GetParam().tolerance);
      EXPECT_EQ(frame.grey.width(), kTestWidth);
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = GetParam().make(folder_.path(), 12);
};

TEST_P(EveryFormat, IsRecognizedAndPlayed) {
  const DatasetOptions at_10_hz{.fps = 10};
  expect_frames(at_10_hz, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
}

TEST_P(EveryFormat, KnowsStartEndStrideAndReverse) {
  expect_frames({.start = 2, .end = 11, .stride = 4, .fps = 10}, {2, 6, 10});
  expect_frames({.start = 2, .end = 11, .stride = 4, .reverse = true, .fps = 10}, {10, 6, 2});
}

TEST_P(EveryFormat, ReadsInAnyOrder) {
  const auto dataset = open_dataset(path_, {.fps = 10});
  for (const int index : {7, 3, 3, 11, 0}) {
    EXPECT_NEAR(dataset->read(index).grey(1, 1), test_frame(index)(1, 1), GetParam().tolerance);
  }
}

TEST_P(EveryFormat, TakesAnotherCalibration) {
  write_text(folder_ / "mine.txt", "FOV 40 41 15.5 11.5 0.5\n32 24\ncrop\n32 24\n");
  const auto dataset = open_dataset(path_, {.calibration_file = folder_ / "mine.txt", .fps = 10});
  EXPECT_EQ(dataset->calibration().camera.model, CameraModelKind::kFov);
}

TEST_P(EveryFormat, RefusesACalibrationOfAnotherSize) {
  write_text(folder_ / "mine.txt", "FOV 40 41 15.5 11.5 0.5\n64 48\ncrop\n32 24\n");
  const std::string message =
      error_of([&] { open_dataset(path_, {.calibration_file = folder_ / "mine.txt", .fps = 10}); });
  EXPECT_NE(message.find("32x24"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         testing::Values(FormatCase{"TumMono", "TUM-mono", make_tum_mono, 0, 0},
                                         FormatCase{"TumMonoZip", "TUM-mono", make_tum_mono_zip, 0, 0},
                                         FormatCase{"Kitti", "KITTI", make_kitti, 0, 0},
                                         FormatCase{"Euroc", "EuRoC", make_euroc, 1403715273.0, 0},
                                         FormatCase{"TumRgbd", "TUM RGB-D", make_tum_rgbd, 0, 0},
                                         FormatCase{"ImageFolder", "image folder", make_image_folder, 0, 0},
                                         FormatCase{"Video", "video", make_video, 0, 4}),
                         [](const auto& test) { return test.param.name; });

TEST(OpenDataset, MissingPathIsAnError) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { open_dataset(folder / "nowhere"); }).find("nowhere: there is no such"), std::string::npos);
}

TEST(OpenDataset, EmptyFolderIsAnError) {
  const TemporaryFolder folder;
  const std::string message = error_of([&] { open_dataset(folder.path()); });
  EXPECT_NE(message.find("the folder is empty"), std::string::npos) << message;
  EXPECT_NE(message.find("KITTI"), std::string::npos) << message;
}

TEST(OpenDataset, UnknownContentSaysWhatWasLookedFor) {
  const TemporaryFolder folder;
  write_text(folder / "notes.txt", "hello");
  for (const auto& path : {folder.path(), folder / "notes.txt"}) {
    const std::string message = error_of([&] { open_dataset(path); });
    EXPECT_NE(message.find("EuRoC: mav0/cam0/data.csv"), std::string::npos) << message;
  }
}

TEST(OpenDataset, FolderOfARecordingNamesTheSequencesInIt) {
  const TemporaryFolder folder;
  write_frame(folder / "drive_0001/image_00/data/0000000000.png", 0);
  write_frame(folder / "drive_0001/image_01/data/0000000000.png", 0);
  const std::string message = error_of([&] { open_dataset(folder / "drive_0001"); });
  EXPECT_NE(message.find("image_00/data, image_01/data: give one of these"), std::string::npos) << message;
  write_frame(folder / "room/rgb/1.png", 0);
  EXPECT_NE(error_of([&] { open_dataset(folder / "room"); }).find("bags in rgb: give"), std::string::npos);
}

TEST(OpenDataset, SeveralKindsOfImagesAreAnErrorAndAPatternChooses) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) {
    write_frame(folder / ("frame-" + std::to_string(i) + ".color.png"), i);
    write_frame(folder / ("frame-" + std::to_string(i) + ".depth.png"), 9);
  }
  write_text(folder / "camera.txt", kTestCamera);
  const std::string message = error_of([&] { open_dataset(folder.path()); });
  EXPECT_NE(message.find("frame-%d.color.png (3), frame-%d.depth.png (3)"), std::string::npos) << message;
  DatasetOptions options;
  options.fps = 10;
  options.pattern = "frame-%d.color.png";
  const auto dataset = open_dataset(folder.path(), options);
  ASSERT_EQ(dataset->size(), 3);
  EXPECT_EQ(dataset->read(2).grey(1, 1), test_frame(2)(1, 1));
}

}  // namespace
}  // namespace ldso
