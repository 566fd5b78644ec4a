// What users bring that is not as it should be: each gives a clear error, or a warning where going on makes sense.

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "ldso/io/dataset.h"
#include "util/prefetching_reader.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class DamagedDataset : public testing::Test {
 protected:
  DamagedDataset() { make_tum_mono(folder_.path(), 8); }

  std::unique_ptr<Dataset> open() const { return open_dataset(folder_.path()); }
  fs::path image(int index) const { return folder_ / ("images/0000" + std::to_string(index) + ".png"); }
  void truncate(int index) const { fs::resize_file(image(index), fs::file_size(image(index)) / 2); }

  TemporaryFolder folder_;
};

TEST_F(DamagedDataset, WithoutCalibrationTheCameraIsAGuess) {
  EXPECT_FALSE(open()->calibration().is_guess());
  fs::remove(folder_ / "camera.txt");
  std::string response;
  for (int level = 0; level < 256; ++level) response += std::to_string(level) + " ";
  write_text(folder_ / "pcalib.txt", response);
  const Calibration calibration = open()->calibration();
  EXPECT_EQ(calibration.source, CameraSource::kNone);
  EXPECT_EQ(calibration.camera.width, 32);
  EXPECT_EQ(calibration.camera.height, 24);
  EXPECT_TRUE(calibration.photometric.inverse_response) << "what is known of its photometry stays";
}

TEST_F(DamagedDataset, AMissingFileThatWasNamedIsAnError) {
  DatasetOptions options;
  options.calibration_file = folder_ / "there_is_none.txt";
  EXPECT_NE(error_of([&] { open_dataset(folder_.path(), options); }).find("there_is_none.txt"), std::string::npos);
}

TEST_F(DamagedDataset, ShortCalibrationIsAnError) {
  write_text(folder_ / "camera.txt", "525 525 319.5 239.5 0\n640 480\n");
  EXPECT_NE(error_of([&] { open(); }).find("has 2 lines, four are expected"), std::string::npos);
}

TEST_F(DamagedDataset, CalibrationForAnotherImageSizeIsAnError) {
  write_text(folder_ / "camera.txt", "Pinhole 525 525 319.5 239.5 0\n640 480\nnone\n640 480\n");
  const std::string message = error_of([&] { open(); });
  EXPECT_NE(message.find("the image is 32x24"), std::string::npos) << message;
  EXPECT_NE(message.find("640x480"), std::string::npos) << message;
}

TEST_F(DamagedDataset, EmptyImageFolderIsAnError) {
  fs::remove_all(folder_ / "images");
  fs::create_directory(folder_ / "images");
  EXPECT_NE(error_of([&] { open(); }).find("there are no images"), std::string::npos);
}

TEST_F(DamagedDataset, OnlyUnreadableImagesAreAnError) {
  for (int i = 0; i < 8; ++i) truncate(i);
  const std::string message = error_of([&] { open(); });
  EXPECT_NE(message.find("truncated"), std::string::npos) << message;
}

TEST_F(DamagedDataset, ATruncatedImageInTheMiddleCostsThatFrameOnly) {
  truncate(3);
  const auto dataset = open();
  ASSERT_EQ(dataset->size(), 8);
  const std::string message = error_of([&] { dataset->read(3); });
  EXPECT_NE(message.find("00003.png: the image file is truncated"), std::string::npos) << message;
  EXPECT_EQ(dataset->read(4).grey(0, 0), 40);
}

TEST_F(DamagedDataset, ATruncatedFirstImageDoesNotPreventOpening) {
  truncate(0);
  EXPECT_EQ(open()->read(1).grey(0, 0), 10);
}

TEST_F(DamagedDataset, AnImageOfAnotherSizeInFrontDoesNotPreventOpening) {
  const Image<float> small(8, 6, 1.0F);
  write_grey_png(image(0), small.view());
  EXPECT_EQ(open()->size(), 8);
}

TEST_F(DamagedDataset, TheReaderAheadHandsTheErrorOver) {
  truncate(3);
  const auto dataset = open();
  PrefetchingReader<RawFrame> reader(
      dataset->size(), [&](int i) { return dataset->read(i); }, 2);
  int readable = 0;
  while (const auto item = reader.next()) {
    EXPECT_EQ(item->error.find("00003.png") != std::string::npos, item->index == 3) << item->error;
    EXPECT_EQ(item->value.has_value(), item->index != 3);
    readable += item->value.has_value() ? 1 : 0;
  }
  EXPECT_EQ(readable, 7);
}

TEST_F(DamagedDataset, ShorterTimesFileKeepsTheFramesThatHaveTimes) {
  write_text(folder_ / "times.txt", "00000 0.0 1\n00001 0.1 1\n00005 0.5 1\n");
  const auto dataset = open();
  ASSERT_EQ(dataset->size(), 3);
  EXPECT_EQ(dataset->read(2).grey(0, 0), 50);
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("8 images and 3 lines"), std::string::npos) << dataset->warnings()[0];
}

TEST_F(DamagedDataset, ImpossibleExposuresAreAWarning) {
  std::string times;
  for (int i = 0; i < 8; ++i)
    times += "0000" + std::to_string(i) + " 0." + std::to_string(i) + (i % 2 ? " NaN\n" : " 0\n");
  write_text(folder_ / "times.txt", times);
  const auto dataset = open();
  EXPECT_FALSE(dataset->read(2).exposure_ms.has_value());
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("8 exposure times"), std::string::npos) << dataset->warnings()[0];
}

TEST_F(DamagedDataset, MissingTimesFileIsAWarning) {
  fs::remove(folder_ / "times.txt");
  const auto dataset = open();
  EXPECT_EQ(dataset->size(), 8);
  EXPECT_NE(dataset->warnings().at(0).find("no times.txt"), std::string::npos);
}

}  // namespace
}  // namespace ldso
