#include "io/text/output_folder.h"

#include <gtest/gtest.h>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    write_file(folder_ / name, text);
  }
  std::string text(const std::string& name) const { return read_file(folder_ / name); }

  fs::path folder_;
};

TEST_F(OutputFolderTest, FilesOfOthersAreNeitherOverwrittenNorRemoved) {
  put("camera.txt", "mine");
  OutputFolder out(folder_);
  out.remove("camera.txt");
  EXPECT_EQ(text("camera.txt"), "mine");
  EXPECT_THROW(out.check({"map.ply", "camera.txt"}), Error);
  EXPECT_THROW(out.file("camera.txt"), Error);
  EXPECT_EQ(text("camera.txt"), "mine");
}

TEST_F(OutputFolderTest, TheMessageNamesFileAndRemedy) {
  put("camera.txt", "mine");
  try {
    OutputFolder(folder_).file("camera.txt");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "camera.txt").string()), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("give another folder"), std::string::npos);
  }
}

TEST_F(OutputFolderTest, WhatWasWrittenCanBeWrittenAgainAndRemovedByALaterRun) {
  write_file(OutputFolder(folder_).file("camera.txt"), "first");
  OutputFolder later(folder_);
  EXPECT_TRUE(later.owns("camera.txt"));
  later.check({"camera.txt"});
  write_file(later.file("camera.txt"), "second");
  EXPECT_EQ(text("camera.txt"), "second");
  later.remove("camera.txt");
  EXPECT_FALSE(fs::exists(folder_ / "camera.txt"));
  // What somebody puts there afterwards is not ldso's.
  put("camera.txt", "mine");
  EXPECT_THROW(OutputFolder(folder_).check({"camera.txt"}), Error);
}

TEST_F(OutputFolderTest, FilesOfAVersionWithoutAListAreAdopted) {
  put("map.ply", "old");
  OutputFolder out(folder_);
  EXPECT_FALSE(out.has_list());
  out.adopt({"map.ply", "trajectory.txt"});
  EXPECT_TRUE(OutputFolder(folder_).owns("map.ply"));
  // What was not there is not taken for ldso's when it is there one day.
  EXPECT_FALSE(OutputFolder(folder_).owns("trajectory.txt"));
}

TEST_F(OutputFolderTest, AFolderThatIsRefusedStaysAsItWas) {
  put("camera.txt", "mine");
  OutputFolder out(folder_);
  out.adopt({"map.ply"});
  EXPECT_THROW(out.check({"camera.txt"}), Error);
  EXPECT_FALSE(OutputFolder::is_one(folder_));
}

TEST_F(OutputFolderTest, AFolderInsideIsOneName) {
  put("images/00000.png", "mine");
  fs::create_directories(folder_ / "depth");
  OutputFolder out(folder_);
  EXPECT_THROW(out.file("images/"), Error);
  EXPECT_NO_THROW(out.file("depth/"));  // Empty: nobody's.
  put("depth/00000.png", "rendered");
  EXPECT_NO_THROW(OutputFolder(folder_).file("depth/"));
}

TEST_F(OutputFolderTest, AFolderThatCannotBeMadeIsSaidSo) {
  put("file", "x");
  EXPECT_THROW(OutputFolder(folder_ / "file" / "out"), Error);
  EXPECT_THROW(OutputFolder(folder_ / "file"), Error);
}

TEST_F(OutputFolderTest, OnlyFilesOfTheSameKindAreOverwrittenByName) {
  put("image.png", "\x89PNG");
  put("old.svg", "<svg/>");
  put("empty", "");
  EXPECT_THROW(refuse_other_file(folder_ / "image.png", {"<svg"}, "a picture"), Error);
  EXPECT_NO_THROW(refuse_other_file(folder_ / "old.svg", {"<svg"}, "a picture"));
  EXPECT_NO_THROW(refuse_other_file(folder_ / "empty", {"<svg"}, "a picture"));
  EXPECT_NO_THROW(refuse_other_file(folder_ / "new", {"<svg"}, "a picture"));
}

}  // namespace
}  // namespace ldso
