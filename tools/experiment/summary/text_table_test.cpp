#include "experiment/summary/text_table.h"

#include <gtest/gtest.h>

#include <limits>

namespace ldso {
namespace {

const TextTable kTable{"ate_x", "Errors in %", {"name_1", "A&B"}, {{{"a|b"}, {"1.5", true}}, {{"c, d"}, {"20"}}}};

TEST(TextTable, Csv) { EXPECT_EQ(table_csv(kTable), "name_1,A&B\na|b,1.5\n\"c, d\",20\n"); }

TEST(TextTable, MarkdownIsAligned) {
  EXPECT_EQ(table_markdown(kTable),
            "| name_1 |     A&B |\n"
            "| ------ | ------: |\n"
            "| a\\|b   | **1.5** |\n"
            "| c, d   |      20 |\n");
}

TEST(TextTable, LatexIsEscaped) {
  const std::string latex = table_latex(kTable);
  EXPECT_NE(latex.find("\\caption{Errors in \\%}"), std::string::npos);
  EXPECT_NE(latex.find("\\label{table:ate_x}"), std::string::npos);
  EXPECT_NE(latex.find("{lr}"), std::string::npos);
  EXPECT_NE(latex.find("name\\_1 & A\\&B \\\\\n"), std::string::npos);
  EXPECT_NE(latex.find("a|b & \\textbf{1.5} \\\\\n"), std::string::npos);
}

TEST(TextTable, NumbersHaveFourDigits) {
  EXPECT_EQ(table_number(0.123456), "0.1235");
  EXPECT_EQ(table_number(0.00123456), "0.001235");
  EXPECT_EQ(table_number(12.3456), "12.35");
  EXPECT_EQ(table_number(1234.56), "1235");
  EXPECT_EQ(table_number(123456.7), "123457");
  EXPECT_EQ(table_number(1.5e-7), "1.500e-07");
  EXPECT_EQ(table_number(0.0), "0.000");
  EXPECT_EQ(table_number(-2.0), "-2.000");
  EXPECT_EQ(table_number(std::numeric_limits<double>::infinity()), "failed");
  EXPECT_EQ(table_number(std::nullopt), "-");
}

}  // namespace
}  // namespace ldso
