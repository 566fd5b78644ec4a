#include "experiment/results/csv.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

TEST(Csv, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(csv_line({"a", "", "b c"}), "a,,b c\n");
  EXPECT_EQ(csv_line({"a,b", "say \"no\"", "two\nlines"}), "\"a,b\",\"say \"\"no\"\"\",\"two\nlines\"\n");
}

TEST(Csv, ReadsWhatItWrites) {
  const std::vector<CsvRow> rows = {{"a,b", "say \"no\"", "two\nlines"}, {"", "x", ""}, {"1", "2", "3"}};
  std::string text;
  for (const CsvRow& row : rows) text += csv_line(row);
  EXPECT_EQ(parse_csv(text), rows);
}

TEST(Csv, TakesWindowsLinesAndALastLineWithoutEnd) {
  EXPECT_EQ(parse_csv("a,b\r\n\r\n1,2"), (std::vector<CsvRow>{{"a", "b"}, {"1", "2"}}));
  EXPECT_TRUE(parse_csv("").empty());
  EXPECT_EQ(parse_csv("a,\n"), (std::vector<CsvRow>{{"a", ""}}));
}

TEST(Csv, AnOpenQuoteIsAnError) { EXPECT_THROW(parse_csv("a,\"b\n1,2\n"), Error); }

}  // namespace
}  // namespace ldso
