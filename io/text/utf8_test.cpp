#include "io/text/utf8.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(Utf8, TellsTextFromOtherBytes) {
  for (const char* text : {"", "abc", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "a\xc2\x80z"})
    EXPECT_TRUE(is_utf8(text)) << text;
  for (const char* bytes : {"\xe4", "\xc3", "\xc3(", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                            "\xff", "\x80", "a\xb9"})
    EXPECT_FALSE(is_utf8(bytes)) << bytes;
}

}  // namespace
}  // namespace ldso
