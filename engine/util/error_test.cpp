#include "ldso/error.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace ldso {
namespace {

TEST(Error, HasItsPartsWhateverIsInThem) {
  const Error error("a: b.txt:7", "holds 3 numbers; 4 are expected", "write it again; or remove it");
  EXPECT_STREQ(error.what(), "a: b.txt:7: holds 3 numbers; 4 are expected; write it again; or remove it");
  EXPECT_EQ(error.context(), "a: b.txt:7");
  EXPECT_EQ(error.problem(), "holds 3 numbers; 4 are expected");
  EXPECT_EQ(error.remedy(), "write it again; or remove it");
  const Error copy = error;
  EXPECT_EQ(copy.remedy(), error.remedy());
  static_assert(std::is_nothrow_copy_constructible_v<Error>);
}

TEST(Error, WithoutPartsIsAllProblem) {
  const Error error("nothing works");
  EXPECT_STREQ(error.what(), "nothing works");
  EXPECT_EQ(error.problem(), "nothing works");
  EXPECT_TRUE(error.context().empty() && error.remedy().empty());
  EXPECT_STREQ(Error("a", "b", "").what(), "a: b");
}

}  // namespace
}  // namespace ldso
