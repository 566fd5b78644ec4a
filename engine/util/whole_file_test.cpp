#include "util/whole_file.h"

#include <gtest/gtest.h>

#include <iterator>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(WholeFile, IsReplacedAndNothingIsLeftBeside) {
  write_file(folder_ / "out.txt", "first");
  write_file(folder_ / "out.txt", std::string("sec\0nd\n", 7));
  EXPECT_EQ(read_file(folder_ / "out.txt"), std::string("sec\0nd\n", 7));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(WholeFile, ErrorsNameTheFile) {
  const auto error_of = [](auto action) -> std::string {
    try {
      action();
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const fs::path missing = folder_ / "no_such_folder" / "out.txt";
  EXPECT_NE(error_of([&] { write_file(missing, "x"); }).find(missing.string()), std::string::npos);
  EXPECT_NE(error_of([&] { read_file(missing); }).find(missing.string()), std::string::npos);
  EXPECT_NE(error_of([&] { read_file(folder_); }).find("is a folder"), std::string::npos);
}

}  // namespace
}  // namespace ldso
