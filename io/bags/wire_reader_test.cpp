#include "io/bags/wire_reader.h"

#include <gtest/gtest.h>

#include "io/bags/test_bags.h"
#include "io/datasets/test_sequences.h"
#include "ldso/error.h"

namespace ldso {
namespace {

TEST(WireReader, ReadsWhatWasWritten) {
  for (const bool is_big_endian : {false, true}) {
    for (const MessageFormat format : {MessageFormat::kRos1, MessageFormat::kCdr}) {
      if (is_big_endian && format == MessageFormat::kRos1) continue;
      WireWriter writer(format, is_big_endian);
      writer.number<std::uint8_t>(7).text("abc").number<std::uint16_t>(513).number(0.1).number<std::uint8_t>(1);
      writer.sequence(Bytes{1, 2, 3}).number<std::int64_t>(-5);
      WireReader reader(writer.bytes(), format, "it");
      EXPECT_EQ(reader.number<std::uint8_t>(), 7);
      EXPECT_EQ(reader.text(), "abc");
      EXPECT_EQ(reader.number<std::uint16_t>(), 513);
      EXPECT_EQ(reader.number<double>(), 0.1);
      EXPECT_EQ(reader.number<std::uint8_t>(), 1);
      EXPECT_EQ(reader.sequence().size(), 3U);
      EXPECT_EQ(reader.number<std::int64_t>(), -5);
      EXPECT_EQ(reader.remaining(), 0U);
    }
  }
}

TEST(WireReader, SecondVersionOfCdrAlignsToFourBytes) {
  Bytes bytes{0, 7, 0, 0, 1, 0, 0, 0};
  bytes.resize(16);
  WireReader reader(bytes, MessageFormat::kCdr, "it");
  EXPECT_EQ(reader.number<std::uint8_t>(), 1);
  EXPECT_EQ(reader.number<double>(), 0);
  EXPECT_EQ(reader.position(), 12U);
}

TEST(WireReader, WhatIsNotThereIsAnError) {
  const Bytes bytes{5, 0, 0, 0, 'a', 'b'};
  EXPECT_NE(error_of([&] { WireReader(bytes, "it").text(); }).find("it: it is cut off: 5 bytes"), std::string::npos);
  EXPECT_THROW(WireReader(bytes, "it").number<double>(), Error);
  EXPECT_NE(error_of([&] { WireReader(bytes, MessageFormat::kCdr, "it"); }).find("serialized"), std::string::npos);
  EXPECT_THROW(WireReader(Bytes{0, 1}, MessageFormat::kCdr, "it"), Error);
}

}  // namespace
}  // namespace ldso
