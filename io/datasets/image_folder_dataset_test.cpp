#include "io/datasets/image_folder_dataset.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(ImageFolderDataset, TakesTimesFromTheRate) {
  const TemporaryFolder folder;
  make_image_folder(folder.path(), 11);
  const auto dataset = open_image_folder_dataset(folder.path(), {.fps = 20});
  EXPECT_DOUBLE_EQ(dataset->timestamp(10), 0.5);
  EXPECT_EQ(dataset->read(10).grey(0, 0), 100) << "shot10 comes after shot9";
  EXPECT_TRUE(dataset->warnings().empty());
}

TEST(ImageFolderDataset, SaysWhichRateItAssumes) {
  const TemporaryFolder folder;
  const auto dataset = open_image_folder_dataset(make_image_folder(folder.path(), 4), {});
  EXPECT_DOUBLE_EQ(dataset->timestamp(3), 0.1);
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("--fps"), std::string::npos);
}

TEST(ImageFolderDataset, PrefersATimesFile) {
  const TemporaryFolder folder;
  make_image_folder(folder.path(), 2);
  write_text(folder / "times.txt", "shot0 5.0 3\nshot1 6.0 4\n");
  const auto dataset = open_image_folder_dataset(folder.path(), {.fps = 10});
  EXPECT_EQ(dataset->timestamp(1), 6.0);
  EXPECT_EQ(dataset->read(1).exposure_ms, 4);
}

}  // namespace
}  // namespace ldso
