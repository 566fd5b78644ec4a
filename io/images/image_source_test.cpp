#include "io/images/image_source.h"

#include <gtest/gtest.h>
#include <zip.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

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

TEST(ImageZip, SaysThatItIsEncrypted) {
  const TemporaryFolder folder;
  const std::string content = "secret";
  int error = 0;
  zip_t* archive = zip_open((folder / "images.zip").c_str(), ZIP_CREATE, &error);
  const zip_int64_t index =
      zip_file_add(archive, "0.png", zip_source_buffer(archive, content.data(), content.size(), 0), 0);
  ASSERT_EQ(zip_file_set_encryption(archive, static_cast<zip_uint64_t>(index), ZIP_EM_AES_256, "password"), 0);
  ASSERT_EQ(zip_close(archive), 0);
  const std::string message = error_of([&] { open_image_zip(folder / "images.zip"); });
  EXPECT_NE(message.find("the archive is encrypted; unpack it"), std::string::npos) << message;
}

}  // namespace
}  // namespace ldso
