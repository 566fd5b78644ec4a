#include "io/datasets/masked_dataset.h"

#include <gtest/gtest.h>

#include <string>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// White in its first `columns`.
void write_mask(const std::filesystem::path& path, int columns, int width = kTestWidth) {
  std::filesystem::create_directories(path.parent_path());
  Image<float> mask(width, kTestHeight, 0.F);
  for (int y = 0; y < kTestHeight; ++y) {
    for (int x = 0; x < columns; ++x) mask(x, y) = 255;
  }
  write_grey_png(path, mask.view());
}

std::unique_ptr<Dataset> open_with(const std::filesystem::path& sequence, const std::filesystem::path& mask) {
  DatasetOptions options;
  options.mask = mask;
  return open_dataset(sequence, options);
}

int masked_columns(const RawFrame& frame) {
  int columns = 0;
  while (columns < frame.grey.width() && frame.grey(columns, 3) < 0) ++columns;
  return columns;
}

TEST(MaskedDataset, OneImageIsForAllFrames) {
  const TemporaryFolder folder;
  const auto sequence = make_image_folder(folder / "sequence", 4);
  write_mask(folder / "mask.png", 5);
  const auto dataset = open_with(sequence, folder / "mask.png");
  EXPECT_EQ(masked_columns(dataset->read(0)), 5);
  EXPECT_EQ(masked_columns(dataset->read(3)), 5);
  EXPECT_EQ(masked_columns(open_dataset(sequence)->read(0)), 0);
}

TEST(MaskedDataset, MasksOfAFolderGoByNames) {
  const TemporaryFolder folder;
  const auto sequence = make_image_folder(folder / "sequence", 4);
  const auto plain = open_dataset(sequence);
  for (const int i : {0, 2}) {
    const std::string stem = std::filesystem::path(plain->frame_name(i)).stem().string();
    write_mask(folder / "masks" / (stem + ".png"), i + 1);
  }
  const auto dataset = open_with(sequence, folder / "masks");
  EXPECT_EQ(masked_columns(dataset->read(0)), 1);
  EXPECT_EQ(masked_columns(dataset->read(1)), 0);
  EXPECT_EQ(masked_columns(dataset->read(2)), 3);
  ASSERT_FALSE(dataset->warnings().empty());
  EXPECT_NE(dataset->warnings().back().find("2 of 4 images have no mask"), std::string::npos);
}

TEST(MaskedDataset, MasksOfOtherNamesGoByTheirOrder) {
  const TemporaryFolder folder;
  const auto sequence = make_image_folder(folder / "sequence", 3);
  for (int i = 0; i < 3; ++i) write_mask(folder / "masks" / ("m" + std::to_string(i) + "_.png"), i + 1);
  EXPECT_EQ(masked_columns(open_with(sequence, folder / "masks")->read(2)), 3);
  write_mask(folder / "masks" / "m3_.png", 1);
  EXPECT_NE(error_of([&] { open_with(sequence, folder / "masks"); }).find("holds 4 masks"), std::string::npos);
}

TEST(MaskedDataset, GoesWithThePlayedFrames) {
  const TemporaryFolder folder;
  const auto sequence = make_image_folder(folder / "sequence", 4);
  for (int i = 0; i < 4; ++i) write_mask(folder / "masks" / ("m" + std::to_string(i) + "_.png"), i + 1);
  DatasetOptions options;
  options.mask = folder / "masks";
  options.start = 1;
  options.reverse = true;
  EXPECT_EQ(masked_columns(open_dataset(sequence, options)->read(0)), 4);
}

TEST(MaskedDataset, RefusesWhatIsNoMaskOfTheImages) {
  const TemporaryFolder folder;
  const auto sequence = make_image_folder(folder / "sequence", 2);
  write_mask(folder / "wide.png", 5, 2 * kTestWidth);
  EXPECT_NE(error_of([&] { open_with(sequence, folder / "wide.png"); }).find("the mask is 64x24"), std::string::npos);
  EXPECT_NE(error_of([&] { open_with(sequence, folder / "none.png"); }).find("none.png"), std::string::npos);
  std::filesystem::create_directories(folder / "empty");
  EXPECT_NE(error_of([&] { open_with(sequence, folder / "empty"); }).find("there is no mask"), std::string::npos);
}

TEST(MaskedDataset, ARoundImageIsMaskedByItself) {
  const TemporaryFolder folder;
  write_text(folder / "round" / "camera.txt", "Pinhole 100 100 80 60 0\n160 120\nnone\n160 120\n");
  for (int i = 0; i < 5; ++i) {
    Image<float> image(160, 120, 0.F);
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        if (std::hypot(x - 80, y - 60) < 55) image(x, y) = 80.F + static_cast<float>((x * 3 + y * 5 + 17 * i) % 100);
      }
    }
    write_grey_png(folder / "round" / (std::to_string(i) + ".png"), image.view());
  }
  const auto dataset = open_dataset(folder / "round");
  const RawFrame frame = dataset->read(2);
  EXPECT_LT(frame.grey(2, 2), 0);
  EXPECT_GE(frame.grey(80, 60), 0);
  EXPECT_NE(dataset->warnings().back().find("the image is round"), std::string::npos);
  EXPECT_EQ(open_with(folder / "round", "none")->read(2).grey(2, 2), 0);
}

}  // namespace
}  // namespace ldso
