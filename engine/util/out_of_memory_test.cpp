#include "util/out_of_memory.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

TEST(OutOfMemory, SaysWhatWasBeingDone) {
  const std::string plain = problem_of(std::bad_alloc(), "reading frame 7");
  EXPECT_EQ(plain.find("out of memory while reading frame 7; "), 0u) << plain;
  const OutOfMemory known("decoding a.png");
  EXPECT_EQ(problem_of(known, "reading frame 7"), known.what());
  EXPECT_EQ(problem_of(Error("a.png", "is bad", "replace it"), "reading frame 7"), "a.png: is bad; replace it");
}

}  // namespace
}  // namespace ldso
