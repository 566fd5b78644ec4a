#include "io/images/image_source.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

TEST(NaturalLess, NumbersCountAsNumbers) {
  EXPECT_TRUE(natural_less("img9.png", "img10.png"));
  EXPECT_FALSE(natural_less("img10.png", "img9.png"));
  EXPECT_TRUE(natural_less("a2b1", "a2b03"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("img01.png", "img1.png"));
  EXPECT_FALSE(natural_less("img1.png", "img01.png"));
  EXPECT_FALSE(natural_less("x.png", "x.png"));
  EXPECT_TRUE(natural_less("99999999999999999999998.png", "99999999999999999999999.png"));
}

TEST(ImageFolder, ListsImagesInOrderAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* name : {"10.png", "9.png", "1.PNG"}) write_frame(folder / name, 0);
  write_frame(folder / "vignette.png", 0);
  write_text(folder / "times.txt", "");
  write_text(folder / "._9.png", "");
  write_text(folder / "thumbs.png/a.txt", "");
  EXPECT_EQ(open_image_folder(folder.path())->names(), (std::vector<std::string>{"1.PNG", "9.png", "10.png"}));
}

TEST(ImageFolder, MissingFolderIsAnError) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { open_image_folder(folder / "images"); }).find("images: is not a folder"), std::string::npos);
}

TEST(ImageZip, YieldsWhatWasPutIn) {
  const TemporaryFolder folder;
  make_tum_mono_zip(folder.path(), 12);
  const auto source = open_image_zip(folder / "images.zip");
  const std::vector<std::string> names = source->names();
  ASSERT_EQ(names.size(), 12U);
  EXPECT_EQ(names[11], "images/00011.png");
  const Image<float> image = decode_grey_image(source->read(names[11]), "a");
  EXPECT_EQ(image(3, 2), test_frame(11)(3, 2));
  EXPECT_EQ(source->describe(names[0]), (folder / "images.zip").string() + ":images/00000.png");
  EXPECT_NE(error_of([&] { source->read("images/99999.png"); }).find("99999.png"), std::string::npos);
}

TEST(ImageZip, DamagedArchiveIsAnError) {
  const TemporaryFolder folder;
  write_text(folder / "images.zip", "this is no archive");
  EXPECT_NE(error_of([&] { open_image_zip(folder / "images.zip"); }).find("zip archive"), std::string::npos);
  make_tum_mono_zip(folder / "b", 3);
  const std::filesystem::path file = folder / "b" / "images.zip";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_NE(error_of([&] { open_image_zip(file); }).find("zip archive"), std::string::npos);
}

TEST(ImageZip, ClaimsOfItsDirectoryAreNotBelieved) {
  const TemporaryFolder folder;
  make_tum_mono_zip(folder.path(), 1);
  std::string bytes = read_file(folder / "images.zip");
  // The size of the unpacked image, little-endian, in the directory at the archive's end: now 4 GB.
  const std::size_t entry = bytes.rfind("PK\x01\x02");
  bytes.replace(entry + 24, 4, "\xf0\xff\xff\xff");
  write_text(folder / "images.zip", bytes);
  const auto source = open_image_zip(folder / "images.zip");
  const std::vector<std::uint8_t> image = source->read(source->names().at(0));
  EXPECT_LT(image.capacity(), 1u << 20);
  EXPECT_EQ(decode_grey_image(image, "a")(3, 2), test_frame(0)(3, 2));
}

}  // namespace
}  // namespace ldso
